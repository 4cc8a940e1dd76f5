"""Live changes of a scene, in order."""

import collections
import queue
import uuid
from typing import Callable

import grpc
import numpy as np
from numpy.typing import ArrayLike

from .errors import DiaphaneError, from_rpc_error
from .reopening import Reopening
from .v1 import scene_service_pb2

_MOST_WAITING = 32
# Positions of more bytes follow their edit, in pieces of whole positions that the server takes.
_INLINE_BYTES = 64 << 10
_PIECE_BYTES = 12 << 16


def float32_rows(values: ArrayLike, width: int, name: str) -> np.ndarray:
    """`values` as a little-endian C array of [n, width]; ValueError names what is of another shape."""
    rows = np.ascontiguousarray(values, dtype="<f4")
    if rows.ndim != 2 or rows.shape[1] != width:
        raise ValueError(f"{name}: must have the shape [n, {width}], got {list(rows.shape)}")
    return rows


def uint32_indices(values: ArrayLike, name: str) -> np.ndarray:
    """`values` as little-endian uint32; ValueError names what a conversion would silently change."""
    indices = np.asarray(values)
    if indices.size and indices.dtype.kind not in "iu":
        raise ValueError(f"{name}: must be integers, got {indices.dtype}")
    if indices.size and not 0 <= (lowest := int(indices.min())) <= (highest := int(indices.max())) < 1 << 32:
        raise ValueError(f"{name}: must be within 0..2^32-1, got {lowest if lowest < 0 else highest}")
    return np.ascontiguousarray(indices, dtype="<u4")


def _requests_of(edit: scene_service_pb2.SceneEdit) -> list[scene_service_pb2.EditSceneRequest]:
    """An edit, and what follows it: long positions, in the order of its changes."""
    payloads = []
    for change in edit.changes:
        positions = change.positions
        form = positions.WhichOneof("values")
        values, field = (positions.quantized, "uint16") if form == "quantized" else (positions, "float32")
        if form is None or len(getattr(values, field)) <= _INLINE_BYTES:
            continue
        data = getattr(values, field)
        positions.payload_bytes = len(data)
        setattr(values, field, b"")
        payloads += [data[first : first + _PIECE_BYTES] for first in range(0, len(data), _PIECE_BYTES)]
    requests = [scene_service_pb2.EditSceneRequest(edit=edit)]
    return requests + [scene_service_pb2.EditSceneRequest(payload=payload) for payload in payloads]


class Deformer:
    """Sends edits without waiting for each; at most 32 are on their way. What is not known to be applied when a
    connection breaks is sent again, in order. One thread at a time.

    An edit that the server refuses is told by whichever call meets it first, and by all after it.
    """

    def __init__(self, open_call: Callable, scene: str, timeout_s: float):
        self._open_call = open_call
        self._scene = scene
        self._id = uuid.uuid4().hex
        self._reopening = Reopening(timeout_s)
        self._call: grpc.Call | None = None
        self._requests: queue.SimpleQueue = queue.SimpleQueue()
        self._waiting: collections.deque = collections.deque()
        self._sequence = 0
        self._revision = 0
        self._failed: DiaphaneError | None = None

    def set_positions(self, mesh: str, positions: ArrayLike, indices: ArrayLike | None = None) -> None:
        """New positions [n, 3] of all vertices of a mesh, or of those at `indices` [n]; mesh units."""
        change = scene_service_pb2.SceneChange()
        change.positions.mesh = mesh
        change.positions.float32 = float32_rows(positions, 3, "positions").tobytes()
        if indices is not None:
            change.positions.indices.extend(uint32_indices(indices, "indices").tolist())
        self.send([change])

    def set_weights(self, mesh: str, weights: ArrayLike) -> None:
        """Of each morph target of a mesh so much."""
        change = scene_service_pb2.SceneChange()
        change.weights.mesh = mesh
        change.weights.weights.extend(np.asarray(weights, dtype=np.float32).tolist())
        self.send([change])

    def morph_to_sphere(self, mesh: str, amount: float) -> None:
        """The uploaded mesh so far, 0..1, on its way to its bounding sphere."""
        change = scene_service_pb2.SceneChange()
        change.sphere.mesh = mesh
        change.sphere.amount = amount
        self.send([change])

    def send(self, changes: list[scene_service_pb2.SceneChange]) -> None:
        """Any changes, applied together as one revision."""
        if self._failed is not None:
            raise self._failed
        self._sequence += 1
        self._waiting.append(_requests_of(scene_service_pb2.SceneEdit(sequence=self._sequence, changes=changes)))
        if self._call is None:
            self._open()
        else:
            self._put(self._waiting[-1])
        if len(self._waiting) >= _MOST_WAITING:
            self._wait_until(_MOST_WAITING // 2)

    def flush(self) -> int:
        """Waits until all is applied; the scene's revision then."""
        self._wait_until(0)
        return self._revision

    def close(self) -> None:
        """Ends the stream; what was not flushed may be lost."""
        self._requests.put(None)
        if self._call is not None:
            self._call.cancel()
            self._call = None

    def __enter__(self) -> "Deformer":
        return self

    def __exit__(self, error_type, *_) -> None:
        try:
            if error_type is None:
                self.flush()
        finally:
            self.close()

    def _wait_until(self, most: int) -> None:
        while len(self._waiting) > most:
            if self._failed is not None:
                raise self._failed
            if self._call is None:
                self._open()
            try:
                applied = next(self._call, None)
                error = DiaphaneError("UNAVAILABLE", "the stream ended")
            except grpc.RpcError as ended:
                applied, error = None, from_rpc_error(ended)
            if applied is not None:
                self._reopening.succeeded()
                self._revision = applied.scene_revision
                while self._waiting and self._waiting[0][0].edit.sequence <= applied.applied:
                    self._waiting.popleft()
                continue
            self._requests.put(None)
            self._call = None
            try:
                self._reopening.wait_after(error)
            except DiaphaneError as final:
                self._failed = final
                raise

    def _open(self) -> None:
        self._requests = queue.SimpleQueue()
        opening = scene_service_pb2.EditOpening(scene=self._scene, editor_id=self._id)
        self._requests.put(scene_service_pb2.EditSceneRequest(opening=opening))
        for waiting in self._waiting:
            self._put(waiting)
        self._call = self._open_call(iter(self._requests.get, None))

    def _put(self, requests: list[scene_service_pb2.EditSceneRequest]) -> None:
        for request in requests:
            self._requests.put(request)
