"""An arch that is too thin

A semicircular arch needs a thickness of 0.1075 of its mean radius, whatever the friction
(Milankovitch 1907). This one has 0.09.
"""

import drystone as ds

arch = ds.scenes.arch(voussoirs=21, thickness=0.09, friction=2.0)
ds.check(arch).draw("04_arch_too_thin.svg")
