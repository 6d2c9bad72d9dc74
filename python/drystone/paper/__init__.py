"""The evidence of Loomis and Balkcom (ICRA 2006), measured again: Table I, Figs. 5, 6 and 7.

And the questions that their section VI leaves open: what reuse gives to other methods.
"""

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
from drystone.paper.table import EXAMPLES, Example, Row, as_tables, measure, write_csv

__all__ = [
    "EXAMPLES",
    "Cases",
    "Example",
    "Measurement",
    "Row",
    "as_tables",
    "measure",
    "measure_methods",
    "methods_as_dicts",
    "methods_table",
    "paper_scenes",
    "write_csv",
    "write_figures",
    "write_methods_csv",
]
