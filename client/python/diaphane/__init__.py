"""Client of Diaphane: translucent bodies that deform, rendered by a server.

    client = diaphane.connect("127.0.0.1:7373")
    with client.create_scene(millimetres_per_unit=10) as scene:
        wax = scene.add_material("wax")
        scene.add_point_light((0, 2, 4), (900, 900, 900))
        body = scene.add_mesh(positions, triangles, wax)
        open("frame.png", "wb").write(scene.render(camera).image)

Arrays are numpy's, positions in mesh units. What the contract says of a field holds here too: the comments of
proto/diaphane/v1. The messages themselves are in diaphane.v1, for what this wrapper has no argument for.
"""

from .client import Camera, Client, Scene, connect
from .deformer import Deformer
from .errors import DiaphaneError
from .frames import Frame, FrameStream

__all__ = ["Camera", "Client", "Deformer", "DiaphaneError", "Frame", "FrameStream", "Scene", "connect"]
