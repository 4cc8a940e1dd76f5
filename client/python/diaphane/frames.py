"""Frames, one at a time and as a scene changes."""

import queue
from dataclasses import dataclass, field
from typing import Callable, Iterator

import grpc

from .errors import DiaphaneError, from_rpc_error
from .reopening import Reopening
from .v1 import render_service_pb2


@dataclass(frozen=True)
class Frame:
    """An encoded picture and what it shows."""

    image: bytes
    content_type: str
    scene_revision: int
    width_px: int
    height_px: int
    stages_ms: dict[str, float] = field(default_factory=dict)  # of those that ran
    at_rest: bool = False  # of a stream: the lossless frame after the last change
    key_frame: bool = False  # of H.264


def frame_of(message: render_service_pb2.RenderFrameResponse, at_rest: bool = False, key_frame: bool = False) -> Frame:
    stages = {stage.stage: stage.milliseconds for stage in message.stages if stage.ran}
    return Frame(
        message.image,
        message.content_type,
        message.scene_revision,
        message.size.width_px,
        message.size.height_px,
        stages,
        at_rest,
        key_frame,
    )


class FrameStream:
    """An iterator of frames: the newest of a scene, as it changes. Comes back after a broken connection.

    next() is for one thread at a time; close() for any.
    """

    def __init__(
        self,
        open_call: Callable,
        opening: render_service_pb2.StreamOpening,
        timeout_s: float,
    ):
        self._open_call = open_call
        self._opening = opening
        self._reopening = Reopening(timeout_s)
        self._call: grpc.Call | None = None
        self._requests: queue.SimpleQueue = queue.SimpleQueue()
        self._closed = False

    def __iter__(self) -> Iterator[Frame]:
        return self

    def __next__(self) -> Frame:
        """The next frame. Raises StopIteration after close(), DiaphaneError what ended the stream."""
        while not self._closed:
            if self._call is None:
                self._open()
            try:
                for response in self._call:
                    self._reopening.succeeded()
                    if response.WhichOneof("part") != "frame":
                        continue
                    self._requests.put(render_service_pb2.StreamFramesRequest(credits=1))
                    streamed = response.frame
                    return frame_of(streamed.frame, streamed.at_rest, streamed.key_frame)
                error = DiaphaneError("UNAVAILABLE", "the stream ended")
            except grpc.RpcError as ended:
                error = from_rpc_error(ended)
            self._call = None
            self._requests.put(None)
            if not self._closed:
                self._reopening.wait_after(error)
        raise StopIteration

    def close(self) -> None:
        """Ends the stream, and a next() that waits."""
        self._closed = True
        self._requests.put(None)
        if self._call is not None:
            self._call.cancel()

    def __enter__(self) -> "FrameStream":
        return self

    def __exit__(self, *_) -> None:
        self.close()

    def _open(self) -> None:
        self._requests = queue.SimpleQueue()
        self._requests.put(render_service_pb2.StreamFramesRequest(opening=self._opening))
        self._call = self._open_call(iter(self._requests.get, None))
