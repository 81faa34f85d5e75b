"""lookstep: a biped walks over rough ground without stopping to think.

```python
import lookstep

summary = lookstep.run(tree="look_and_step", course="rough", seed=3)
```
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from lookstep.options import RunOptions

if TYPE_CHECKING:
    from lookstep.summary import Summary

__all__ = ["RunOptions", "run"]


def run(**options: Any) -> Summary:
    """Walk once and return the figures; the options are the fields of `RunOptions`.

    Raises:
        YamlError, UserError: where the input is not usable.
    """
    from lookstep.walk import walk

    return walk(RunOptions(**options))
