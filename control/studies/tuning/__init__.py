"""Auto-tune: the best values of some axes for this robot and plate, by Bayesian optimisation within a budget."""

from control.studies.tuning.answer import Answer, Interval, answer
from control.studies.tuning.plan import TunePlan
from control.studies.tuning.surface import Sample, Surface, learned_surface

__all__ = ["Answer", "Interval", "Sample", "Surface", "TunePlan", "answer", "learned_surface"]
