"""The time of a keystroke in the workbench at 200x60: python keystroke.py TIPSTRIKE...

Opens the driver's face width of Table 1 in each program in turn, types digits of it, and prints the
time from the key to the last byte of the screen with its results (median and 99th percentile), and the
processor time of a key, in ms.
"""

import fcntl
import os
import pathlib
import pty
import select
import shutil
import struct
import sys
import tempfile
import termios
import time

KEYS = 400
#: The row of the face width below that of the module.
DOWN = 13
#: A screen is complete after this silence, in s.
SILENCE = 0.05
CASE = pathlib.Path(__file__).parent.parent / "cases" / "zhou-chen-2014.toml"


def last_byte(terminal):
    """Reads until silence; the time of the last byte."""
    seen = time.perf_counter()
    while select.select([terminal], [], [], SILENCE)[0]:
        os.read(terminal, 1 << 20)
        seen = time.perf_counter()
    return seen


def processor(child):
    """The processor time of a process so far, in s."""
    words = pathlib.Path(f"/proc/{child}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


def keystrokes(program, method):
    home = pathlib.Path(tempfile.mkdtemp())
    case = home / "case.toml"
    text = CASE.read_text(encoding="utf-8")
    text = text.replace('method = "exact"', f'method = "{method}"').replace('deflection = "24.7 um"', "")
    case.write_text(text, encoding="utf-8")
    child, terminal = pty.fork()
    if child == 0:
        os.environ.update(TERM="xterm-256color", LANG="C.UTF-8", HOME=str(home), XDG_STATE_HOME=str(home),
                          XDG_CONFIG_HOME=str(home))
        os.execv(program, [program, str(case)])
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 60, 200, 0, 0))
    time.sleep(0.5)
    last_byte(terminal)
    os.write(terminal, b"\x1b[B" * DOWN + b"8")
    time.sleep(1.0)
    last_byte(terminal)
    times, used = [], processor(child)
    for key in [".", "1", "\x7f", "\x7f"] * (KEYS // 4):
        begin = time.perf_counter()
        os.write(terminal, key.encode())
        times.append(1e3 * (last_byte(terminal) - begin))
    used = 1e3 * (processor(child) - used) / KEYS
    os.kill(child, 9)
    os.waitpid(child, 0)
    os.close(terminal)
    shutil.rmtree(home)
    return sorted(times), used


for method in ["exact", "static", "dynamic"]:
    for program in sys.argv[1:]:
        times, used = keystrokes(program, method)
        print(f"{method:8} {times[KEYS // 2]:6.2f} ms, 99th percentile {times[KEYS * 99 // 100]:6.2f} ms,"
              f" processor {used:5.2f} ms  {program}")
