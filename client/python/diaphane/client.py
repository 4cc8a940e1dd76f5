"""Servers and scenes."""

import hashlib
import uuid
from dataclasses import dataclass
from typing import Iterator, Sequence

import grpc
import numpy as np
from numpy.typing import ArrayLike

from .deformer import Deformer, float32_rows, uint32_indices
from .errors import told_as_one
from .frames import Frame, FrameStream, frame_of
from .v1 import (
    common_pb2,
    frame_pb2,
    render_service_pb2,
    render_service_pb2_grpc,
    scene_service_pb2,
    scene_service_pb2_grpc,
    server_service_pb2,
    server_service_pb2_grpc,
)

_CHUNK_BYTES = 1 << 20
_MOST_MESSAGE_BYTES = 1 << 30
_FORMATS = {
    "png": frame_pb2.IMAGE_FORMAT_PNG,
    "jpeg": frame_pb2.IMAGE_FORMAT_JPEG,
    "exr": frame_pb2.IMAGE_FORMAT_EXR,
    "webp": frame_pb2.IMAGE_FORMAT_WEBP,
    "h264": frame_pb2.IMAGE_FORMAT_H264,
}

Triple = Sequence[float]


def _vec3(values: Triple) -> common_pb2.Vec3:
    x, y, z = values
    return common_pb2.Vec3(x=x, y=y, z=z)


def _one_per_vertex(values: ArrayLike, vertices: int, name: str) -> np.ndarray:
    # The server sees the sum of all lengths alone: what one array lacks, another may make up for.
    rows = float32_rows(values, 3, name)
    if len(rows) != vertices:
        raise ValueError(f"{name}: must have one row per position ({vertices}), got {len(rows)}")
    return rows


def _encoding(image_format: str, quality: int = 0) -> frame_pb2.Encoding:
    if image_format not in _FORMATS:
        raise ValueError(f"image_format: must be one of {', '.join(_FORMATS)}, got {image_format!r}")
    return frame_pb2.Encoding(format=_FORMATS[image_format], quality=quality)


@dataclass(frozen=True)
class Camera:
    """A pinhole camera in scene units, right-handed; fov_y_deg is the full vertical angle."""

    eye: Triple
    target: Triple = (0, 0, 0)
    up: Triple = (0, 1, 0)
    fov_y_deg: float = 30

    def to_proto(self) -> frame_pb2.Camera:
        return frame_pb2.Camera(
            eye=_vec3(self.eye), target=_vec3(self.target), up=_vec3(self.up), fov_y_deg=self.fov_y_deg
        )


class Client:
    """A connection to one server. Thread-safe."""

    def __init__(self, address: str, timeout_s: float = 10):
        limits = [("grpc.max_receive_message_length", _MOST_MESSAGE_BYTES)]
        self._channel = grpc.insecure_channel(address, options=limits)
        self.timeout_s = timeout_s
        self.scenes = scene_service_pb2_grpc.SceneServiceStub(self._channel)
        self.frames = render_service_pb2_grpc.RenderServiceStub(self._channel)
        self._server = server_service_pb2_grpc.ServerServiceStub(self._channel)

    def info(self) -> server_service_pb2.ServerInfo:
        """What the server is, and what it allows. Waits for it, at most timeout_s."""
        with told_as_one():
            return self._server.GetServerInfo(
                server_service_pb2.GetServerInfoRequest(), timeout=self.timeout_s, wait_for_ready=True
            )

    def create_scene(self, millimetres_per_unit: float = 1, display_name: str = "") -> "Scene":
        """A scene without anything in it. Translucency depends on real size: say how long a unit is."""
        request = scene_service_pb2.CreateSceneRequest(request_id=uuid.uuid4().hex)
        request.scene.millimetres_per_unit = millimetres_per_unit
        request.scene.display_name = display_name
        with told_as_one():
            return Scene(self, self.scenes.CreateScene(request).name)

    def close(self) -> None:
        self._channel.close()

    def __enter__(self) -> "Client":
        return self

    def __exit__(self, *_) -> None:
        self.close()


def connect(address: str, timeout_s: float = 10) -> Client:
    """Connects to a server at HOST:PORT or unix:PATH, and waits until it answers.

    Streams that break are opened again for as long as timeout_s. Raises DiaphaneError where nothing answers.
    """
    client = Client(address, timeout_s)
    try:
        client.info()
    except BaseException:
        client.close()
        raise
    return client


class Scene:
    """A scene on a server. Thread-safe. As a context manager it is deleted at the end."""

    def __init__(self, client: Client, name: str):
        self._client = client
        self.name = name

    def add_material(self, preset: str) -> str:
        """One of the server's presets, such as "wax" or "marble"; its resource name."""
        request = scene_service_pb2.CreateMaterialRequest(parent=self.name, request_id=uuid.uuid4().hex)
        request.material.preset = preset
        with told_as_one():
            return self._client.scenes.CreateMaterial(request).material.name

    def add_point_light(self, position: Triple, intensity_w_sr: Triple) -> str:
        """A point light: scene units, W/sr for red, green and blue; its resource name."""
        request = scene_service_pb2.CreateLightRequest(parent=self.name, request_id=uuid.uuid4().hex)
        request.light.point.position.CopyFrom(_vec3(position))
        request.light.point.intensity.CopyFrom(_vec3(intensity_w_sr))
        with told_as_one():
            return self._client.scenes.CreateLight(request).light.name

    def add_mesh(
        self,
        positions: ArrayLike,
        triangles: ArrayLike,
        material: str,
        normals: ArrayLike | None = None,
        morph_targets: Sequence[ArrayLike] = (),
    ) -> str:
        """Uploads a mesh: positions [n, 3] in mesh units, triangles [m, 3], counter-clockwise from outside; normals
        [n, 3] where they are not to be computed; of each morph target the displacements [n, 3]. Its resource name.
        """
        rows = float32_rows(positions, 3, "positions")
        corners = uint32_indices(triangles, "triangles")
        if corners.ndim != 2 or corners.shape[1] != 3:
            raise ValueError(f"triangles: must have the shape [m, 3], got {list(corners.shape)}")
        parts = [rows]
        if normals is not None:
            parts.append(_one_per_vertex(normals, len(rows), "normals"))
        parts.append(corners)
        parts += [_one_per_vertex(target, len(rows), "morph_targets") for target in morph_targets]
        payload = b"".join(part.tobytes() for part in parts)
        header = scene_service_pb2.MeshHeader(
            parent=self.name,
            vertex_count=len(rows),
            triangle_count=len(corners),
            has_normals=normals is not None,
            morph_target_count=len(morph_targets),
            total_bytes=len(payload),
            sha256=hashlib.sha256(payload).digest(),
            request_id=uuid.uuid4().hex,
        )
        header.mesh.material = material

        def upload() -> Iterator[scene_service_pb2.UploadMeshRequest]:
            yield scene_service_pb2.UploadMeshRequest(header=header)
            for begin in range(0, len(payload), _CHUNK_BYTES):
                yield scene_service_pb2.UploadMeshRequest(chunk=payload[begin : begin + _CHUNK_BYTES])

        with told_as_one():
            return self._client.scenes.UploadMesh(upload()).mesh.name

    def render(
        self,
        camera: Camera,
        size_px: tuple[int, int] = (1280, 720),
        image_format: str = "png",
        settings: frame_pb2.RenderSettings | None = None,
    ) -> Frame:
        """One frame of the newest revision: it shows every change that returned before this call."""
        request = render_service_pb2.RenderFrameRequest(
            scene=self.name,
            camera=camera.to_proto(),
            size=common_pb2.Size(width_px=size_px[0], height_px=size_px[1]),
            settings=settings,
            encoding=_encoding(image_format),
        )
        with told_as_one():
            return frame_of(self._client.frames.RenderFrame(request))

    def stream(
        self,
        camera: Camera,
        size_px: tuple[int, int] = (1280, 720),
        image_format: str = "jpeg",
        settings: frame_pb2.RenderSettings | None = None,
        lossless_at_rest: bool = True,
        every_revision: bool = False,
        frames_in_flight: int = 2,
    ) -> FrameStream:
        """Frames as the scene changes. The newest win; with every_revision none is passed over."""
        view = render_service_pb2.StreamView(
            sequence=1,
            camera=camera.to_proto(),
            size=common_pb2.Size(width_px=size_px[0], height_px=size_px[1]),
            settings=settings,
            moving=_encoding(image_format),
            lossless_at_rest=lossless_at_rest,
        )
        opening = render_service_pb2.StreamOpening(
            scene=self.name, view=view, credits=frames_in_flight, every_revision=every_revision
        )
        return FrameStream(self._client.frames.StreamFrames, opening, self._client.timeout_s)

    def deform(self) -> Deformer:
        """A way for live changes."""
        return Deformer(self._client.scenes.EditScene, self.name, self._client.timeout_s)

    def remove(self) -> None:
        """Deletes the scene and all that is in it."""
        with told_as_one():
            self._client.scenes.DeleteScene(scene_service_pb2.DeleteSceneRequest(name=self.name))

    def __enter__(self) -> "Scene":
        return self

    def __exit__(self, *_) -> None:
        self.remove()
