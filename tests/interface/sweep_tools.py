"""What the tests of sweeps share."""

import sys
from concurrent.futures import Executor, Future
from contextlib import contextmanager

COMMAND = [sys.executable, "-W", "error::RuntimeWarning", "-c", "from damperopt.cli import main; main()", "sweep"]

ANALYSIS = {"run": "analyse", "vary": {"gear.caster_length": [0.1, "120 mm", 0.2], "damper.torsional_damping": [300.0, 900.0]}}

SWEEP = """\
name: nose gear
base: {base}
run: analyse
vary:
  gear.caster_length: {{from: 80 mm, to: 160 mm, points: 5}}
  damper.torsional_damping: [300 N m s/rad, 900 N m s/rad]
"""


@contextmanager
def inline():
    """An executor that works at once, in this process."""

    class Inline(Executor):
        def submit(self, work, /, *given, **named):
            future = Future()
            try:
                future.set_result(work(*given, **named))
            except BaseException as error:
                future.set_exception(error)
            return future

    yield Inline()
