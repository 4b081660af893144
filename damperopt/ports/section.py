"""Shapes of cross-sections as a study gives them."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import model_validator

from ..quantities.record import Number, Record, refuse
from ..quantities.units import Quantity

__all__ = ["Section"]


class Section(Record):
    """Cross-section family of a beam: one shape at every size.

    tube: wall over outer diameter `thickness_ratio`; rectangle: `aspect_ratio` height over width (bending along the
    height); i_section: `aspect_ratio` height over flange width, `thickness_ratio` flange and web thickness over height.
    """

    family: Literal["solid_round", "tube", "rectangle", "i_section"] = "tube"
    """Shape; a tube takes thickness_ratio, a rectangle aspect_ratio, an i_section both."""
    thickness_ratio: Annotated[float, Quantity("1", above=0, below=0.5)] | None = None
    """Wall over outer diameter, or flange and web over height [1]."""
    aspect_ratio: Number | None = None
    """Height over width [1]."""

    @model_validator(mode="after")
    def _shape(self) -> Self:
        needs = {
            "solid_round": set(),
            "tube": {"thickness_ratio"},
            "rectangle": {"aspect_ratio"},
            "i_section": {"thickness_ratio", "aspect_ratio"},
        }[self.family]
        given = {key for key in ("thickness_ratio", "aspect_ratio") if getattr(self, key) is not None}
        if given != needs:
            raise refuse(
                "", f"family '{self.family}' was given {sorted(given) or 'no ratio'}", f"exactly {sorted(needs) or 'no ratio'}"
            )
        if self.thickness_ratio and self.aspect_ratio and self.thickness_ratio * self.aspect_ratio >= 1:
            raise refuse("", "the web is as wide as the flange", "thickness_ratio * aspect_ratio < 1")
        return self
