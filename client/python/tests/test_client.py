"""The Python client against a real server."""

import contextlib
import os
import pathlib
import socket
import subprocess
import sys
import tempfile
import threading
import unittest

import numpy as np

import diaphane
from diaphane.v1 import frame_pb2

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "examples"))
import deform  # noqa: E402

SERVER = os.environ["DIAPHANE_SERVER"]
CAMERA = diaphane.Camera(eye=(0, 0, 6))
LAMBERT = frame_pb2.RenderSettings(technique=frame_pb2.TECHNIQUE_LAMBERT)
SIZE = (64, 48)


class Server:
    """A server of the test's own; it ends with its standard input."""

    def __init__(self, listen: str = "127.0.0.1:0"):
        self.process = subprocess.Popen(
            [SERVER, "--listen", listen, "--exit-with-stdin", "--log-level", "error"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self.address = self.process.stdout.readline().rsplit(" ", 1)[-1].strip()

    def stop(self) -> None:
        self.process.stdin.close()
        self.process.wait(timeout=60)
        self.process.stdout.close()


class ClientTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.server = Server()
        cls.client = diaphane.connect(cls.server.address)

    @classmethod
    def tearDownClass(cls) -> None:
        cls.client.close()
        cls.server.stop()

    def setUp(self) -> None:
        self.scene = self.client.create_scene(millimetres_per_unit=10)
        self.addCleanup(self.scene.remove)
        self.material = self.scene.add_material("marble")
        self.positions, self.triangles = deform.ball(8, 12)
        self.body = self.scene.add_mesh(self.positions, self.triangles, self.material)
        self.scene.add_point_light((0, 2, 6), (900, 900, 900))

    def test_renders_what_was_uploaded(self) -> None:
        frame = self.scene.render(CAMERA, SIZE, settings=LAMBERT)
        self.assertEqual(frame.image[:4], b"\x89PNG")
        self.assertEqual((frame.width_px, frame.height_px), SIZE)
        self.assertIn("encode", frame.stages_ms)
        self.assertEqual(self.scene.render(CAMERA, SIZE, "webp", LAMBERT).content_type, "image/webp")

    def test_tells_a_refusal_by_code_and_field(self) -> None:
        with self.assertRaises(diaphane.DiaphaneError) as refused:
            self.scene.render(CAMERA, (0, 48))
        self.assertEqual(refused.exception.code, "INVALID_ARGUMENT")
        self.assertEqual(refused.exception.field, "size.width_px")
        with self.assertRaises(diaphane.DiaphaneError) as unknown:
            self.scene.add_material("mud")
        self.assertEqual(unknown.exception.field, "material.preset")
        with self.assertRaises(diaphane.DiaphaneError) as infinite:
            self.scene.add_mesh(np.full_like(self.positions, np.inf), self.triangles, self.material)
        self.assertEqual(infinite.exception.code, "INVALID_ARGUMENT")

    def test_refuses_arrays_of_another_shape_before_any_call(self) -> None:
        with self.assertRaisesRegex(ValueError, r"positions: must have the shape \[n, 3\], got \[3\]"):
            self.scene.add_mesh([0, 1, 2], self.triangles, self.material)
        with self.assertRaisesRegex(ValueError, "triangles"):
            self.scene.add_mesh(self.positions, self.triangles.ravel(), self.material)
        with self.assertRaisesRegex(ValueError, "image_format"):
            self.scene.render(CAMERA, SIZE, "bmp")

    def test_refuses_indices_that_a_conversion_would_change(self) -> None:
        wrapping = self.triangles.astype(np.int64)
        wrapping[0, 0] += 1 << 32
        with self.assertRaisesRegex(ValueError, r"triangles: must be within 0\.\.2\^32-1, got 429496"):
            self.scene.add_mesh(self.positions, wrapping, self.material)
        with self.assertRaisesRegex(ValueError, "triangles: must be integers, got float64"):
            self.scene.add_mesh(self.positions, self.triangles + 0.7, self.material)
        with self.scene.deform() as deformer:
            for indices in ([0.7], [1 << 32], [-1]):
                with self.assertRaisesRegex(ValueError, "indices: must be"):
                    deformer.set_positions(self.body, [(0, 3, 0)], indices=indices)

    def test_refuses_normals_that_another_array_makes_up_for(self) -> None:
        longer = np.zeros((len(self.positions) + 1, 3))
        with self.assertRaisesRegex(ValueError, "normals: must have one row per position"):
            self.scene.add_mesh(self.positions, self.triangles, self.material, self.positions[:-1], [longer])
        with self.assertRaisesRegex(ValueError, "morph_targets: must have one row per position"):
            self.scene.add_mesh(self.positions, self.triangles, self.material, None, [longer])

    def test_edits_are_shown_by_the_next_frame(self) -> None:
        before = self.scene.render(CAMERA, SIZE, settings=LAMBERT)
        with self.scene.deform() as deformer:
            for _ in range(100):
                deformer.set_positions(self.body, [(0, 3, 0)], indices=[0])
            revision = deformer.flush()
        after = self.scene.render(CAMERA, SIZE, settings=LAMBERT)
        self.assertEqual(after.scene_revision, revision)
        self.assertEqual(revision, before.scene_revision + 100)
        self.assertNotEqual(after.image, before.image)

    def test_edits_of_more_than_a_message_are_shown_too(self) -> None:
        positions, triangles = deform.ball(600, 800)
        smaller = (0.5 * positions).astype(np.float32)
        self.assertGreater(smaller.nbytes, 4 << 20)
        images = []
        for uploaded in (positions, smaller):
            scene = self.client.create_scene(millimetres_per_unit=10)
            self.addCleanup(scene.remove)
            body = scene.add_mesh(uploaded, triangles, scene.add_material("marble"))
            with scene.deform() as deformer:
                deformer.set_positions(body, smaller)
            images.append(scene.render(CAMERA, SIZE, settings=LAMBERT).image)
        self.assertEqual(images[0], images[1])

    def test_morphs_by_weights_and_to_the_sphere(self) -> None:
        lift = np.zeros_like(self.positions)
        lift[:, 1] = 1
        body = self.scene.add_mesh(self.positions, self.triangles, self.material, morph_targets=[lift])
        with self.scene.deform() as deformer:
            deformer.set_weights(body, [0.5])
            deformer.morph_to_sphere(body, 0)
            deformer.flush()
        wrong = self.scene.deform()
        with self.assertRaises(diaphane.DiaphaneError) as refused:
            wrong.set_weights(body, [0.5, 1])
            wrong.flush()
        self.assertEqual(refused.exception.field, "changes[0].weights.weights")
        with self.assertRaises(diaphane.DiaphaneError):
            wrong.morph_to_sphere(body, 1)
        wrong.close()

    def test_streams_every_revision_then_the_lossless_one(self) -> None:
        with self.scene.stream(CAMERA, SIZE, settings=LAMBERT, every_revision=True) as frames:
            first = next(frames)
            with self.scene.deform() as deformer:
                for i in range(10):
                    deformer.set_positions(self.body, self.positions * (1 + 0.01 * i))
            revisions = [next(frames).scene_revision for _ in range(10)]
            self.assertEqual(revisions, list(range(first.scene_revision + 1, first.scene_revision + 11)))
            last = next(frames)
            self.assertTrue(last.at_rest)
            self.assertEqual(last.image, self.scene.render(CAMERA, SIZE, settings=LAMBERT).image)

    def test_the_example_saves_frames_that_differ(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            deform.main(self.server.address, pathlib.Path(folder), poses=6)
            images = [path.read_bytes() for path in sorted(pathlib.Path(folder).glob("pose_*.jpg"))]
        self.assertEqual(len(images), 6)
        self.assertEqual(len(set(images)), 6)


class Relay:
    """Passes bytes on to a server, until it cuts every connection."""

    def __init__(self, address: str):
        host, port = address.rsplit(":", 1)
        self._server = (host, int(port))
        self._sockets: list[socket.socket] = []
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.address = f"127.0.0.1:{self._listener.getsockname()[1]}"
        threading.Thread(target=self._accept, daemon=True).start()

    def cut(self) -> None:
        for end in self._sockets:
            with contextlib.suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)
            end.close()
        self._sockets = []

    def stop(self) -> None:
        self._listener.shutdown(socket.SHUT_RDWR)
        self._listener.close()
        self.cut()

    def _accept(self) -> None:
        with contextlib.suppress(OSError):
            while True:
                near, _ = self._listener.accept()
                far = socket.create_connection(self._server)
                self._sockets += [near, far]
                for source, sink in ((near, far), (far, near)):
                    threading.Thread(target=self._pass_on, args=(source, sink), daemon=True).start()

    @staticmethod
    def _pass_on(source: socket.socket, sink: socket.socket) -> None:
        with contextlib.suppress(OSError):
            while data := source.recv(1 << 16):
                sink.sendall(data)


class ReplayTest(unittest.TestCase):
    def test_sparse_edits_over_cut_connections_end_where_the_client_is(self) -> None:
        server = Server()
        self.addCleanup(server.stop)
        relay = Relay(server.address)
        self.addCleanup(relay.stop)
        with diaphane.connect(server.address) as direct, diaphane.connect(relay.address, 20) as through:
            positions, triangles = deform.ball(8, 12)
            positions = positions.astype(np.float32)

            def scene_of(rows: np.ndarray) -> tuple[diaphane.Scene, str]:
                scene = direct.create_scene(millimetres_per_unit=10)
                scene.add_point_light((0, 2, 6), (900, 900, 900))
                return scene, scene.add_mesh(rows, triangles, scene.add_material("marble"))

            scene, body = scene_of(positions)
            before = scene.render(CAMERA, SIZE, settings=LAMBERT).image
            random = np.random.default_rng(1)
            with diaphane.Scene(through, scene.name).deform() as deformer:
                for i in range(300):
                    moved = random.choice(len(positions), 5, replace=False)
                    positions[moved] *= 1 + 0.05 * random.random((5, 1), dtype=np.float32)
                    deformer.set_positions(body, positions[moved], indices=moved)
                    if i % 50 == 49:
                        relay.cut()
            after = scene.render(CAMERA, SIZE, settings=LAMBERT).image
            self.assertNotEqual(after, before)
            self.assertEqual(after, scene_of(positions)[0].render(CAMERA, SIZE, settings=LAMBERT).image)


class ReconnectTest(unittest.TestCase):
    def test_a_stream_comes_back_to_a_server_that_was_restarted(self) -> None:
        server = Server()
        client = diaphane.connect(server.address, timeout_s=20)
        scene = client.create_scene()
        scene.add_mesh(*deform.ball(8, 12), scene.add_material("wax"))
        frames = scene.stream(CAMERA, SIZE, settings=LAMBERT)
        next(frames)
        server.stop()
        again = Server(server.address)
        # The scene was in memory alone: the new server does not know it, and says so.
        with self.assertRaises(diaphane.DiaphaneError) as gone:
            while True:
                next(frames)
        self.assertEqual(gone.exception.code, "NOT_FOUND")
        frames.close()
        client.close()
        again.stop()

    def test_nothing_answers_is_unavailable(self) -> None:
        with self.assertRaises(diaphane.DiaphaneError) as nobody:
            diaphane.connect("127.0.0.1:1", timeout_s=0.5)
        self.assertIn(nobody.exception.code, ("UNAVAILABLE", "DEADLINE_EXCEEDED"))


if __name__ == "__main__":
    unittest.main()
