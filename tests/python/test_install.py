"""The package as pip installs it, without a network: pytest finds the plugin by itself."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

PACKAGE = Path(__file__).parents[2] / "estimators/foreign/python"


def test_pip_installs_the_package_and_pytest_finds_the_plugin(tmp_path):
    source = tmp_path / "source"
    shutil.copytree(PACKAGE, source, ignore=shutil.ignore_patterns("build", "*.egg-info", "__pycache__"))
    environment = {**os.environ, "PIP_CONFIG_FILE": os.devnull, "PIP_ROOT_USER_ACTION": "ignore"}
    environment.pop("PYTHONPATH")
    subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--no-build-isolation", "--no-index",
                    "--no-deps", "--target", tmp_path / "site", source], check=True, env=environment)
    assert (tmp_path / "site/assay/py.typed").exists()
    (tmp_path / "test_mine.py").write_text('''
import assay

@assay.claim("mean(it) == 0.5", detect="1%")
def mine(rng):
    return rng.random()
''')
    environment["PYTHONPATH"] = str(tmp_path / "site")
    ended = subprocess.run([sys.executable, "-m", "pytest", "-q", "--rootdir", tmp_path, tmp_path / "test_mine.py"],
                           cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    assert "1 passed" in ended.stdout
