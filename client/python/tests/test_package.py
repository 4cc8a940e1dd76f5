"""What pip makes of build/python."""

import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile

import diaphane

LACKING = [name for name in ("setuptools", "wheel") if importlib.util.find_spec(name) is None]


class Package(unittest.TestCase):
    @unittest.skipIf(LACKING, f"not installed: {', '.join(LACKING)}")
    def test_holds_the_client_its_types_and_the_contract_alone(self):
        built = pathlib.Path(diaphane.__file__).parents[1]
        with tempfile.TemporaryDirectory() as folder:
            package = pathlib.Path(folder) / "package"
            shutil.copytree(built, package, ignore=shutil.ignore_patterns("__pycache__"))
            subprocess.run(
                [sys.executable, "-c", "from setuptools import build_meta; build_meta.build_wheel('..')"],
                cwd=package,
                env={**os.environ, "PYTHONPATH": ""},
                check=True,
                capture_output=True,
                text=True,
            )
            (wheel,) = pathlib.Path(folder).glob("diaphane-*.whl")
            names = set(zipfile.ZipFile(wheel).namelist())
        self.assertLessEqual(
            {
                "diaphane/__init__.py",
                "diaphane/client.py",
                "diaphane/py.typed",
                "diaphane/v1/scene_service_pb2.py",
                "diaphane/v1/scene_service_pb2.pyi",
                "diaphane/v1/scene_service_pb2_grpc.py",
            },
            names,
        )
        self.assertEqual({name.split("/")[0].split("-")[0] for name in names}, {"diaphane"})


if __name__ == "__main__":
    unittest.main()
