"""lookstep: a biped walks over rough ground without stopping to think."""
