"""The options of a deep Q-network, whoever wrote it, so that two of them have the same numbers."""

from typing import ClassVar

from pydantic import Field

from upswing.study import architecture
from upswing.study.values import Count, LayerSizes, Positive, Steps


class DeepQOptions(architecture.Architecture):
    """The size of the network, and how it learns."""

    takes: ClassVar[tuple[architecture.Features, ...]] = ("state",)
    hidden: LayerSizes = Field(
        min_length=1, description="Numbers of units of its hidden layers, input side first."
    )
    # With 1 a run swung up too, yet in the end only from 10 of 16 starts without exploring.
    action_repeat: Count = Field(
        default=4, description="Number of steps that an action is held; 4 are 20 ms."
    )
    # That is all of a run of 200,000 steps, so that nothing of such a run is forgotten.
    replay_capacity: Count = Field(
        default=50_000, description="Largest number of decisions that are remembered."
    )
    batch_size: Count = Field(
        default=64, description="Number of decisions that are learned from at once."
    )
    # A minibatch is then more than one swing.
    learning_starts: Steps = Field(
        default=1_000, description="Number of steps before the first update."
    )
    # With 16 a run takes half the time; one of three then never swung up.
    update_interval: Count = Field(
        default=8, description="Number of steps from one update to the next."
    )
    target_update_interval: Count = Field(
        default=250,
        description="Number of updates between two renewals of the target network; 250 are 10 s.",
    )
    # With 0.01 three of three runs took longer to solve full control.
    q_unit: Positive = Field(
        default=0.03,
        description="The network's own unit of Q, as a share of the largest |Q| there can be: it says "
        "which errors the Huber loss takes for small.",
    )

    def check(self) -> None:
        """It has an algorithm of its own."""
        if self.method != "q-learning":
            raise ValueError("a dqn has an algorithm of its own; leave `method` out")
