"""The evidence of Loomis and Balkcom (ICRA 2006), measured again: Table I, Figs. 5, 6 and 7."""

from drystone.paper.figures import write_figures
from drystone.paper.table import EXAMPLES, Example, Row, as_tables, measure, write_csv

__all__ = ["EXAMPLES", "Example", "Row", "as_tables", "measure", "write_csv", "write_figures"]
