"""Optima that several tests look at, found once."""

import pytest

import damperopt


@pytest.fixture(scope="session")
def optimum(main_gear):
    """Result of the main gear for a layout, kept between tests."""
    kept: dict[str, damperopt.DesignResult] = {}

    def of(topology: str) -> damperopt.DesignResult:
        if topology not in kept:
            kept[topology] = damperopt.optimise(main_gear.replace(damper__topology=topology))
        return kept[topology]

    return of
