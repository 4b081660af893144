"""Lines of progress where no terminal shows a bar."""

import re
import time

from damperopt.commands import shared


def _lines(capfd, steps, pause):
    with shared.bar() as shown:
        task = shown.add_task("work", total=steps)
        for done in range(steps):
            time.sleep(pause)
            shown.update(task, completed=done + 1)
    return capfd.readouterr().err.splitlines()


def test_last_line_says_all_that_was_done(capfd, monkeypatch):
    monkeypatch.setattr(shared, "SECONDS_A_LINE", 0.2)
    lines = _lines(capfd, 3, 0.13)  # the last line by the clock comes before the last step
    assert len(lines) >= 2
    assert re.fullmatch(r"work: 3 of 3, \d+ s", lines[-1])
    assert len({line.split(",")[0] for line in lines}) == len(lines)  # no line twice


def test_short_work_is_silent(capfd):
    assert _lines(capfd, 2, 0.0) == []
