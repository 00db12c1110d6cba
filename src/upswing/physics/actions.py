"""What the actions are, in words: for agents from elsewhere, figures and pages."""

from collections.abc import Sequence


def indices(count: int) -> str:
    """The indices of so many actions: ``0, 1 or 2``; of many, ``a whole number from 0 to 20``."""
    if count > 5:
        return f"a whole number from 0 to {count - 1}"
    return listed([str(index) for index in range(count)], "or")


def pushes(accelerations: Sequence[float], last: str = "and") -> str:
    """What the actions do to the cart [m/s²]: ``−10, 0 and +10``."""
    return listed([signed(one) for one in accelerations], last)


def signed(acceleration: float) -> str:
    """An acceleration [m/s²] with its sign, and with a minus that is as wide as the plus."""
    return f"{acceleration:+g}".replace("-", "−") if acceleration else "0"


def listed(words: Sequence[str], last: str = "and") -> str:
    """Words as a sentence lists them."""
    return f" {last} ".join([", ".join(words[:-1]), words[-1]] if words[1:] else words)
