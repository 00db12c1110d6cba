"""A window that shows the pendulum while it moves, in real time: ``render_mode="human"``."""

from time import monotonic, sleep
from typing import Any

import numpy as np
from numpy.typing import NDArray

BETWEEN_PICTURES = 0.04
"""The time from one picture to the next [s]."""

WIDTH = 720
"""Of the window's picture [pixels]."""


class NoWindow(RuntimeError):
    """There is no display, or nothing to draw a window with."""


class Window:
    """A window of matplotlib's, of whatever toolkit there is.

    Args:
        title: of the window.

    Raises:
        NoWindow: none can be opened.
    """

    def __init__(self, title: str) -> None:
        import matplotlib.pyplot as plt

        plt.close(plt.figure())  # this chooses what draws, if nobody has chosen yet
        drawn_by = plt.get_backend()
        if drawn_by.lower() not in _with_windows():
            raise NoWindow(
                'render_mode "human" needs a display and a toolkit that matplotlib can draw with '
                f"(tkinter or Qt); here it draws with {drawn_by}, which has no windows. "
                'Take "rgb_array" where there is none'
            )
        size = WIDTH / 100, WIDTH / 150
        # Whoever made it a rule that figures are laid out does not mean this one.
        self._figure = plt.figure(figsize=size, dpi=100, layout="none")
        if self._figure.canvas.manager is not None:
            self._figure.canvas.manager.set_window_title(title)
        self._axes = self._figure.add_axes((0, 0, 1, 1), frameon=False, xticks=(), yticks=())
        self._shown: Any = None
        self.restart()

    def restart(self) -> None:
        """Take the next picture for the first of an episode."""
        self._time, self._shown_at = 0.0, -BETWEEN_PICTURES
        self._begun = monotonic()

    def is_due(self, passed: float) -> bool:
        """Let ``passed`` seconds of the simulation go by; whether it is time for a picture."""
        self._time += passed
        return self._time - self._shown_at >= BETWEEN_PICTURES - 1e-9

    def show(self, picture: NDArray[np.uint8]) -> None:
        """Show a picture (height, width, 3) when its time has come; not in a window that was closed."""
        import matplotlib.pyplot as plt

        self._shown_at = self._time
        sleep(max(0.0, self._begun + self._time - monotonic()))
        if not plt.fignum_exists(self._figure.number):
            return
        if self._shown is None:
            self._shown = self._axes.imshow(picture)
            self._figure.show(warn=False)
        self._shown.set_data(picture)
        self._figure.canvas.draw_idle()
        self._figure.canvas.flush_events()

    def close(self) -> None:
        """Close the window."""
        import matplotlib.pyplot as plt

        plt.close(self._figure)


def _with_windows() -> list[str]:
    """What matplotlib can draw with that has windows."""
    from matplotlib.backends.registry import BackendFilter, backend_registry

    of_ours = backend_registry.list_builtin(BackendFilter.INTERACTIVE)  # type: ignore[no-untyped-call]
    return [name.lower() for name in of_ours]
