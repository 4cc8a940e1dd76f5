"""Deforms a mesh that numpy made, and saves the frames that come of it. usage: deform.py ADDRESS OUTDIR"""

import pathlib
import sys

import numpy as np

import diaphane


def ball(rings: int = 48, sides: int = 96) -> tuple[np.ndarray, np.ndarray]:
    """A unit ball: positions [n, 3] and triangles [m, 3]."""
    polar = np.linspace(0, np.pi, rings + 1)[1:-1, None]
    around = np.linspace(0, 2 * np.pi, sides, endpoint=False)[None, :]
    belt = np.stack(
        [np.sin(polar) * np.cos(around), np.cos(polar) + 0 * around, -np.sin(polar) * np.sin(around)], axis=-1
    ).reshape(-1, 3)
    positions = np.vstack([belt, [[0, 1, 0], [0, -1, 0]]])
    top, bottom = len(belt), len(belt) + 1
    triangles = []
    for side in range(sides):
        beside = (side + 1) % sides
        triangles.append((top, side, beside))
        last = (rings - 2) * sides
        triangles.append((bottom, last + beside, last + side))
        for ring in range(rings - 2):
            a, b = ring * sides + side, ring * sides + beside
            triangles += [(a, a + sides, b), (b, a + sides, b + sides)]
    return positions, np.array(triangles)


def main(address: str, folder: pathlib.Path, poses: int = 24) -> None:
    positions, triangles = ball()
    folder.mkdir(parents=True, exist_ok=True)
    camera = diaphane.Camera(eye=(0, 1, 6))
    with diaphane.connect(address) as client, client.create_scene(millimetres_per_unit=10) as scene:
        scene.add_point_light((2, 2, -3), (900, 900, 900))
        scene.add_point_light((-2, 3, 4), (300, 300, 300))
        body = scene.add_mesh(positions, triangles, scene.add_material("wax"))
        frames = scene.stream(camera, (320, 320), every_revision=True, lossless_at_rest=False)
        with frames, scene.deform() as deformer:
            next(frames)  # the ball at rest
            for pose in range(poses):
                phase = 2 * np.pi * pose / poses
                swell = 1 + 0.25 * np.sin(4 * positions[:, 1:2] + phase)
                deformer.set_positions(body, positions * swell)
                (folder / f"pose_{pose:02}.jpg").write_bytes(next(frames).image)
    print(f"{poses} frames in {folder}")


if __name__ == "__main__":
    main(sys.argv[1], pathlib.Path(sys.argv[2]))
