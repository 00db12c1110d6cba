"""Controllers and their pupils as a textbook has them, in numpy alone."""

import numpy as np

LARGE = {"NL": -10, "NS": -5, "ZE": 0, "PS": 5, "PL": 10}
"""What each word says of the cart's acceleration [m/s²]."""

DIAGONAL = ("PL", "PL", "PL", "PS", "ZE", "NS", "NL", "NL", "NL")
"""The usual table of rules has one word for each sum of the two terms, from both lowest to both highest."""


def truths(x, large):
    """How true each of the five terms is of ``x``: triangles of one width, the outer two without an end."""
    peaks = np.linspace(-large, large, 5)
    rises = np.clip(1 - np.abs(np.clip(x, -large, large) - peaks) / (large / 2), 0, 1)
    return rises / rises.sum()


def fuzzy(angle, velocity, angle_large, velocity_large):
    """What the rules want [m/s²] at φ [rad], φ̇ [rad/s]."""
    of_angle = truths(angle, np.radians(angle_large))
    of_velocity = truths(velocity, velocity_large)
    wanted = 0.0
    for i in range(5):
        for j in range(5):
            wanted += of_angle[i] * of_velocity[j] * LARGE[DIAGONAL[i + j]]
    return wanted


class Pupil:
    """Networks with one hidden layer, a tuple of arrays w, b, v, c, that learn by Adam."""

    def __init__(self, w, b, v, c, biased):
        self.parts = [np.array(part, float) for part in (w, v, b, c)]
        self.learned = self.parts if biased else self.parts[:2]
        self.moments = [[np.zeros_like(part), np.zeros_like(part)] for part in self.learned]
        self.t = 0

    def gradients(self, x, wanted):
        """Of the mean over examples and actions of (answer − wanted)², by the chain rule."""
        w, v, b, c = self.parts
        of_w, of_v, of_b, of_c = (np.zeros_like(part) for part in self.parts)
        examples, actions = wanted.shape
        for n in range(examples):
            for a in range(actions):
                h = 1 / (1 + np.exp(-(x[n] @ w[a] + b[a])))
                error = 2 * (v[a] @ h + c[a] - wanted[n, a]) / (examples * actions)
                back = error * v[a] * h * (1 - h)
                of_v[a] += error * h
                of_c[a] += error
                of_b[a] += back
                of_w[a] += np.outer(x[n], back)
        return [of_w, of_v, of_b, of_c]

    def learn(self, x, wanted, rate):
        """One step of Adam (Kingma and Ba, 2015) with its authors' constants."""
        self.t += 1
        changes = self.gradients(x, wanted)
        for part, change, moments in zip(self.learned, changes, self.moments, strict=False):
            moments[0] = 0.9 * moments[0] + 0.1 * change
            moments[1] = 0.999 * moments[1] + 0.001 * change**2
            mean, square = moments[0] / (1 - 0.9**self.t), moments[1] / (1 - 0.999**self.t)
            part -= rate * mean / (np.sqrt(square) + 1e-8)
