"""One thread for linear algebra, unless the user says otherwise: has to be imported before NumPy.

Matrices here are small, a few hundred rows. OpenBLAS (and MKL) divide them among all cores all the same, and its
threads wait for each other in a loop: on a machine that does something else besides, a check of recordings took three
times as long as in one thread (docs/diagnosis.md).
"""

import os

for _name in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")
