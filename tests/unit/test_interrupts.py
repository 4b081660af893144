"""What an interrupt does, in processes of their own."""

import signal
import subprocess
import sys

import pytest

BEGIN = "import os, signal, sys, time; from damperopt import interrupts; interrupts.listen()\n"


def run(code):
    return subprocess.run([sys.executable, "-c", BEGIN + code], capture_output=True, text=True, timeout=60)


@pytest.mark.parametrize(("name", "code"), [("SIGINT", 130), ("SIGTERM", 143)])
def test_before_the_work_it_ends_the_process_at_once(name, code):
    done = run(f"os.kill(os.getpid(), signal.{name}); print('went on')")
    assert (done.returncode, done.stdout) == (code, "")
    assert "Traceback" not in done.stderr


def test_one_that_was_swallowed_is_raised_again():
    done = run(
        "interrupts.AGAIN = 0.1; interrupts.begin()\n"
        "try: os.kill(os.getpid(), signal.SIGINT); time.sleep(1)\n"
        "except BaseException: pass  # as a library does\n"
        "try: time.sleep(20); print('lost')\n"
        "except KeyboardInterrupt: interrupts.answered(); print('again', interrupts.exit_code())\n"
        "time.sleep(0.5); print('once')\n"
    )
    assert done.stdout.split() == ["again", "130", "once"], done.stderr


def test_it_waits_until_results_are_whole_and_a_second_one_does_not():
    done = run(
        "interrupts.begin(); interrupts.ONE_PRESS = 0.0\n"
        "with interrupts.held('writing') as came:\n"
        "    os.kill(os.getpid(), signal.SIGTERM); print('whole')\n"
        "print(came == [signal.SIGTERM])\n"
        "try:\n"
        "    with interrupts.held():\n"
        "        for _ in range(2): os.kill(os.getpid(), signal.SIGINT)\n"
        "        print('not reached')\n"
        "except KeyboardInterrupt: print('dropped')\n"
    )
    assert done.stdout.split() == ["whole", "True", "dropped"], done.stderr
    assert "writing" in done.stderr


def test_workers_end_with_a_parent_that_is_killed(tmp_path):
    file = tmp_path / "parent.py"
    file.write_text(
        "import os, signal, time\nfrom damperopt.workers import process_pool\n"
        "def main():\n"
        "    with process_pool(1) as pool:\n"
        "        print(pool.submit(os.getpid).result(), flush=True)\n"
        "        pool.submit(time.sleep, 60)\n"
        "        os.kill(os.getpid(), signal.SIGKILL)\n"
        "if __name__ == '__main__': main()\n"
    )
    done = subprocess.run([sys.executable, file], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, timeout=60)
    assert done.returncode == -signal.SIGKILL  # and its output is closed: no worker holds it any longer
    import psutil

    assert not psutil.pid_exists(int(done.stdout)) or psutil.Process(int(done.stdout)).status() == "zombie"
