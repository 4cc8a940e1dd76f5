"""What a server refuses, as one exception."""

import contextlib
from typing import Iterator

import grpc
from google.protobuf import any_pb2  # noqa: F401  (the details hold its messages)
from google.rpc import error_details_pb2, status_pb2


class DiaphaneError(Exception):
    """A refusal, or a server that cannot be reached.

    code: the canonical code's name, such as "INVALID_ARGUMENT".
    field: the path of what was wrong, such as "size.width_px"; empty where the server names none.
    """

    def __init__(self, code: str, message: str, field: str = ""):
        super().__init__(f"{code}: {message}")
        self.code = code
        self.message = message
        self.field = field


def from_rpc_error(error: grpc.RpcError) -> DiaphaneError:
    field = ""
    for key, value in error.trailing_metadata() or ():
        if key != "grpc-status-details-bin":
            continue
        for detail in status_pb2.Status.FromString(value).details:
            info = error_details_pb2.ErrorInfo()
            if detail.Unpack(info):
                field = info.metadata.get("field", "")
    return DiaphaneError(error.code().name, error.details() or "", field)


@contextlib.contextmanager
def told_as_one() -> Iterator[None]:
    """Turns gRPC's errors into DiaphaneError."""
    try:
        yield
    except grpc.RpcError as error:
        raise from_rpc_error(error) from None
