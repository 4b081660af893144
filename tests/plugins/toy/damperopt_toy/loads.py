"""A company's own load case: a jack under one wheel slips."""

from __future__ import annotations

from typing import ClassVar, Literal

from damperopt.load_cases.base import Context, LoadCase, Loads
from damperopt.quantities.record import Fraction


class SlippedJack(LoadCase):
    """A jack slips: a side force of a third of the vertical, on the lever of the contact point."""

    RULE: ClassVar[str] = "our design manual, 7.3"
    READ: ClassVar[str] = "edition 4"

    kind: Literal["slipped_jack"]
    side: Fraction = 1 / 3
    """Side force over F_z [1]."""

    def forces(self, context: Context) -> Loads:
        return Loads(context.static, self.side * context.static, lever=context.e_eff, acts_at="jacking point")
