"""Check a run again."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.markup import escape

from .shared import all_or_nothing, out

__all__ = ["verify"]


def verify(
    run: Annotated[Path, typer.Argument(metavar="RUN", help="Folder of a run of 'optimise'.")],
) -> None:
    """Check proofs, mass, requirements and bound of a run of 'optimise' again, from its files alone.

    Checksums, the study, the proofs of stability (with an actuator, and with it off), mass and requirements, decay, and the
    lower bound on the mass from the root of its tree. All else, such as prices and margins of safety, by its checksum alone.
    Exit code 0: all of it holds; 2: no run; 4: something does not hold.
    """
    with all_or_nothing():
        held = _checked(run)
    out.print("[bold green]verified[/]" if held else "[bold red]NOT verified[/]")
    if not held:
        raise typer.Exit(4)


def _checked(run: Path) -> bool:
    """Each finding, shown; whether all of them hold."""
    from ..answers.sums import altered
    from ..errors import ConfigError
    from ..proof.again import Finding, check_again
    from ..reading import printable
    from ..results import load_result

    if run.is_file():
        raise ConfigError(f"{printable(run)}: is a file; allowed: the folder of a run of 'optimise'")
    result = load_result(run)
    wrong = altered(run)
    held = _shown(Finding("files", not wrong, "; ".join(wrong) or "as they were written"))
    study, why = _study(run, result)
    held &= _shown(Finding("study", not why, why or "that of the result"))
    if study is None:
        return False
    for finding in check_again(study, result, _tree(run)):
        held &= _shown(finding)
    if result.status != "solved" and result.mass is not None:
        held &= _shown(Finding("status", False, f"{result.status}: {result.message}"))
    return held


def _shown(finding: Any) -> bool:
    mark = "[green]holds[/]" if finding.holds else "[red]FAILS[/]"
    out.print(f"{finding.claim}: {mark}: {escape(finding.words)}", soft_wrap=True)
    return bool(finding.holds)


def _study(run: Path, result: Any) -> tuple[Any, str]:
    """The study of a run, and what is wrong with it."""
    from hashlib import sha256

    from ..errors import ConfigError
    from ..study import config
    from ..study.study import Study

    file = next((place / "config.yaml" for place in (run, run.parent) if (place / "config.yaml").is_file()), None)
    if file is None:
        return None, "config.yaml is missing"
    try:
        study: Study = config.load(file)
        topology, material = result.topology, result.config.get("material", study.material.name)
        if topology != study.damper.topology:
            study = study.replace(damper__topology=topology)
        if material != study.material.model_dump(mode="json") and material != study.material.name:
            study = study.replace(material=material)
        if result.stock is not None:
            study = study.replace(**{path.replace(".", "__"): value for path, value in result.stock.changes.items()})
    except ConfigError as error:
        return None, str(error)
    if study.model_dump(mode="json") != result.config:
        return study, "config.yaml is not the study that the result holds"
    if result.provenance is not None and sha256(file.read_bytes()).hexdigest() != result.provenance.config_sha256:
        return study, "config.yaml does not have the checksum that the result names"
    return study, ""


def _tree(run: Path) -> Any:
    from ..answers.sums import BOUND_FILE

    file = run / BOUND_FILE
    if not file.is_file():
        return None
    try:
        found = json.loads(file.read_text(encoding="utf-8"))
    except (ValueError, RecursionError):
        return {}
    return found if isinstance(found, dict) else {}
