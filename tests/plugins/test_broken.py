"""What is wrong with a plug-in is one message that names its distribution, whichever command is asked."""

from pathlib import Path

import pytest

MINIMAL = Path(__file__).parents[2] / "configs" / "minimal.yaml"
HEAD = """
from typing import ClassVar, Literal
from damperopt.dampers.hydraulic import Hydraulic
from damperopt.quantities.named import DesignVariable
from damperopt.quantities.record import Length
from damperopt.tyres.laws.linear import LinearLaw
"""
BROKEN = {
    "import error": ("slip_laws", "import nowhere_to_be_found", "nowhere_to_be_found"),
    "no such class": ("slip_laws", "Thing = dict", "is no SlipLaw"),
    "no such name": ("slip_laws", "Other = 1", "cannot be loaded"),
    "base without a tag": ("slip_laws", "from damperopt.tyres.base import SlipLaw as Thing", "is no SlipLaw"),
    "tag twice": ("slip_laws", "class Thing(LinearLaw): law: Literal['linear']", "'linear' is used twice"),
    "tag an older spelling": ("slip_laws", "class Thing(LinearLaw): law: Literal['fiala']", "'fiala' is used twice"),
    "key of every tyre": ("slip_laws", "class Thing(LinearLaw):\n law: Literal['t']\n pressure: Length", "'pressure'"),
    "key of a layout": ("dampers", "class Thing(Hydraulic):\n kind: Literal['t']\n geometry: Length", "'geometry'"),
    "key of the joints": ("dampers", "class Thing(Hydraulic):\n kind: Literal['t']\n freeplay: Length", "'freeplay'"),
    "unit of a variable": (
        "dampers",
        "class Thing(Hydraulic):\n kind: Literal['t']\n VARIABLES: ClassVar = (DesignVariable('k_lambda', 'm'),)",
        "'k_lambda'",
    ),
}


@pytest.mark.parametrize(
    "what", [pytest.param(what, marks=[] if what == "tag twice" else [pytest.mark.slow]) for what in BROKEN]
)
def test_is_one_message(commands, tmp_path, what):
    group, code, words = BROKEN[what]
    place = tmp_path / "site"
    metadata = place / "bad_parts-1.0.dist-info"
    metadata.mkdir(parents=True)
    (place / "bad_parts.py").write_text(HEAD + code + "\n")
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: bad-parts\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text(f"[damperopt.{group}]\nthing = bad_parts:Thing\n")
    lines = ["schema", "components", f"validate {MINIMAL}", f"optimise {MINIMAL} -o design", f"analyse {MINIMAL}"]
    for line, answer in zip(lines, commands(place, *lines), strict=True):
        assert answer["code"] == 2, (line, answer)
        assert "bad-parts" in answer["err"], (line, answer)
        assert words in answer["err"], (line, answer)
        assert answer["err"].count("\n") == 1, (line, answer)
    assert not (tmp_path / "design").exists()
