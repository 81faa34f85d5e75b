"""How good and how fast perception is: scenes with ground truth, a judge, the paper's method as a baseline, timing."""
