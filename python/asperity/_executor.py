"""Computations on executors of `concurrent.futures`, such as processes of this machine or of a cluster."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import CancelledError, Executor, as_completed
from typing import Any

from ._errors import FieldError
from ._notation import refused_type

#: Number of parts of a computation. It is above the usual number of processes, so that all of them end at about the same time.
_PARTS = 32


def check_executor(executor: Any) -> None:
    """Raises a FieldError unless the object has the method of an executor."""
    if not callable(getattr(executor, "submit", None)):
        raise refused_type("executor", executor, "an executor of concurrent.futures, such as ProcessPoolExecutor(), or None")


def ranges(count: int) -> list[tuple[int, int]]:
    """Divides `count` items into ranges of about the same size: the first index, and the one after the last."""
    parts = min(count, _PARTS)
    return [(count * part // parts, count * (part + 1) // parts) for part in range(parts)]


def gathered(
    executor: Executor,
    task: Callable[..., str],
    arguments: Sequence[tuple[Any, ...]],
    sizes: Sequence[int],
    progress: Callable[[int, int], object] | None,
) -> list[str]:
    """Computes a task with each of several arguments on an executor, and returns the results in the order of the arguments.

    `sizes` are the numbers of items of the tasks, for the progress. If a task fails or the computation is interrupted, the tasks
    that have not begun are cancelled.
    """
    futures = [executor.submit(task, *one) for one in arguments]
    size_of = dict(zip(futures, sizes, strict=True))
    done = 0
    try:
        if progress is not None and all(hasattr(future, "_condition") for future in futures):
            for future in as_completed(futures):
                done += size_of[future]
                progress(done, sum(sizes))
        return [future.result() for future in futures]
    except CancelledError:
        raise FieldError(
            "executor: its tasks were cancelled", "executor", str(executor), "an executor that is not shut down"
        ) from None
    finally:
        for future in futures:
            future.cancel()
