"""The program. `asperity` and `python -m asperity` open the explorer or run a command."""

import signal
import sys


def main() -> int:
    """Runs the program with the arguments of this process, and returns its exit code."""
    from asperity._native import program

    # The program handles the terminal and its signals itself; an interrupt ends a command at once.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return program(sys.argv)


if __name__ == "__main__":
    sys.argv[0] = "asperity"
    sys.exit(main())
