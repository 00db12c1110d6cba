"""A run in Parquet: its trajectory, whole where it is looked at closely, and its windows."""

import json
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from upswing.runs.files.atomic import written
from upswing.runs.files.provenance import KEY
from upswing.runs.files.typed_table import Columns
from upswing.study.errors import BadInput
from upswing.study.measured import Windows

if TYPE_CHECKING:
    from upswing.physics.environment import Trajectory

WHOLE_AT_START = 5_000
"""The first steps, kept whole (figures 5 and 7 show them) [steps]."""

WHOLE_AT_END = 2_500
WHOLE_AROUND_FALL = 100
WHOLE_FALLS = 20
"""Number of first falls kept with the steps around them; of later falls only the step itself is."""

WHOLE_BEFORE_SUCCESS, WHOLE_AFTER_SUCCESS = 500, 1_500
THINNED = 4_000
"""Approximate number of steps, evenly spread, that are kept of the rest."""

SCHEMA = pa.schema(
    [
        pa.field("step", pa.int64()),
        pa.field("angle", pa.float32(), metadata={"unit": "rad"}),
        pa.field("angular_velocity", pa.float32(), metadata={"unit": "rad/s"}),
        pa.field("cart_position", pa.float32(), metadata={"unit": "m"}),
        pa.field("cart_velocity", pa.float32(), metadata={"unit": "m/s"}),
        pa.field("action", pa.int8(), metadata={"unit": "index of −10, 0, +10 m/s²"}),
        pa.field("reward", pa.float32(), metadata={"unit": "rad²"}),
        pa.field("td_error", pa.float32(), metadata={"unit": "rad²"}),
        pa.field("reset", pa.bool_()),
    ]
)

WINDOW_COUNTS = (
    "first_step", "steps", "falls", "swing_ups", "too_fast", "excursions", "recovered",
)  # fmt: skip

DIGESTED = Windows._fields[: Windows._fields.index("swing_ups")]
"""The windows' columns in a digest; the later ones say nothing that these and the steps do not."""

OF_A_TRAJECTORY: Columns = {
    name: {"action": "whole", "step": "whole", "reset": "truth"}.get(name, "number")
    for name in SCHEMA.names
}
OF_WINDOWS: Columns = {
    name: "whole" if name in WINDOW_COUNTS else "number" for name in Windows._fields
}


def kept_steps(trajectory: "Trajectory", first_stable_step: int | None) -> NDArray[np.int64]:
    """The steps of a trajectory that are stored, in order, shape (kept,)."""
    steps = len(trajectory.angle)
    kept = np.zeros(steps, dtype=np.bool_)
    kept[:: max(1, steps // THINNED)] = True
    kept[:WHOLE_AT_START] = True
    kept[-WHOLE_AT_END:] = True
    if first_stable_step is not None:
        kept[
            max(0, first_stable_step - WHOLE_BEFORE_SUCCESS) : first_stable_step
            + WHOLE_AFTER_SUCCESS
        ] = True
    resets = np.flatnonzero(trajectory.reset)
    for reset in resets[:WHOLE_FALLS]:
        kept[max(0, reset - WHOLE_AROUND_FALL) : reset + WHOLE_AROUND_FALL] = True
    kept[resets] = True
    return np.flatnonzero(kept)


def digest(trajectory: "Trajectory", steps: NDArray[np.int64], windows: "Windows") -> str:
    """What tells two runs apart: a checksum of the stored ``steps`` and of the windows of all steps."""
    checksum = sha256()
    whole = (column[steps] for column in _columns(trajectory))
    for column in (*whole, *(getattr(windows, name) for name in DIGESTED)):
        checksum.update(np.ascontiguousarray(column).tobytes())
    return checksum.hexdigest()[:16]


def write_trajectory(
    path: Path, trajectory: "Trajectory", steps: NDArray[np.int64], metadata: dict[bytes, bytes]
) -> None:
    """Store the given ``steps`` of a trajectory."""
    columns = [steps, *(column[steps] for column in _columns(trajectory))]
    table = pa.table(columns, schema=SCHEMA.with_metadata(metadata))
    _write(path, table)


def _columns(trajectory: "Trajectory") -> list[NDArray[Any]]:
    """The columns of a trajectory in the order of the schema, which has the step before them."""
    return [getattr(trajectory, name) for name in SCHEMA.names[1:]]


def write_windows(path: Path, windows: "Windows", metadata: dict[bytes, bytes]) -> None:
    """Store the windows of a run; counts as integers, all else as 32-bit numbers."""
    columns = {
        name: pa.array(column, pa.int64() if name in WINDOW_COUNTS else pa.float32())
        for name, column in windows._asdict().items()
    }
    _write(path, pa.table(columns).replace_schema_metadata(metadata))


def read_metadata(path: Path) -> dict[str, Any]:
    """Our part of a run's metadata: ``provenance``, ``spec``, ``run`` and the like.

    Raises:
        BadInput: the file cannot be read, or is not of a run.
    """
    try:
        content = json.loads(pq.read_schema(path).metadata[KEY])
        of_run = isinstance(content["spec"], str) and isinstance(content["run"], str)
        if of_run and isinstance(content["provenance"]["packages"], dict):
            found: dict[str, Any] = content
            return found
    except (OSError, pa.ArrowException, KeyError, TypeError, ValueError, RecursionError) as error:
        said = (str(error).splitlines() or [""])[0]
        if isinstance(error, OSError | pa.ArrowException):
            raise BadInput([f"{path}: cannot be read: {said}"]) from None
    raise BadInput([f"{path}: is not a file of a run: it does not say of which"])


def _write(path: Path, table: pa.Table) -> None:
    floats = [field.name for field in table.schema if pa.types.is_floating(field.type)]
    integers = [field.name for field in table.schema if pa.types.is_int64(field.type)]
    with written(path) as beside:
        pq.write_table(
            table,
            beside,
            compression="zstd",
            use_dictionary=False,
            column_encoding={
                **dict.fromkeys(floats, "BYTE_STREAM_SPLIT"),
                **dict.fromkeys(integers, "DELTA_BINARY_PACKED"),
            },
        )
