"""The Python face, for notebooks: open a folder of results, look at a cell or a run, train one.

``upswing`` itself hands out everything here. Nothing below imports it.
"""

from upswing.api.cell import Cell as Cell
from upswing.api.policy import Policy as Policy
from upswing.api.policy import load as load
from upswing.api.run import DifferentRun as DifferentRun
from upswing.api.run import Run as Run
from upswing.api.study import Study as Study
from upswing.api.study import open as open
from upswing.api.training import train as train
from upswing.study.errors import BadInput as BadInput
