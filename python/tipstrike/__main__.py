"""The command `tipstrike`."""

import signal
import sys


def main():
    # The command handles Ctrl-C itself.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    from ._tipstrike import main as run

    return run(["tipstrike", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
