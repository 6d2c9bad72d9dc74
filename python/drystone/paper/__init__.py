"""The evidence of Loomis and Balkcom (ICRA 2006), measured again: Table I, Figs. 1 and 4 to 7.

And the questions that their section VI leaves open: what reuse gives to other methods.
"""

from drystone.common.extras import extra

with extra("all", "published measurements"):
    from drystone.paper.figures import write_figures
    from drystone.paper.methods import (
        Cases,
        Measurement,
        measure_methods,
        methods_as_dicts,
        methods_table,
        paper_scenes,
        write_methods_csv,
    )
    from drystone.paper.motion import (
        MOTIONS,
        Measured,
        measure_motions,
        motion_tables,
        write_motion_csv,
    )
    from drystone.paper.motion_figures import write_motion_figures
    from drystone.paper.table import EXAMPLES, Example, Row, as_tables, measure, write_csv

__all__ = [
    "EXAMPLES",
    "MOTIONS",
    "Cases",
    "Example",
    "Measured",
    "Measurement",
    "Row",
    "as_tables",
    "measure",
    "measure_methods",
    "measure_motions",
    "methods_as_dicts",
    "methods_table",
    "motion_tables",
    "paper_scenes",
    "write_csv",
    "write_figures",
    "write_methods_csv",
    "write_motion_csv",
    "write_motion_figures",
]
