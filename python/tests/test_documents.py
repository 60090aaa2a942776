"""The Python programs of the documents and the examples run, and print what the documents say."""

from __future__ import annotations

import os
import re
import subprocess
import sys

import numpy as np
import pytest
from tables import REPOSITORY

EXAMPLES = REPOSITORY / "python" / "examples"
PROGRAMS = [
    pytest.param(*program, id=f"{document}-{i}")
    for document in ["README.md", "python/README.md"]
    for i, program in enumerate(
        re.findall(
            r"^```python\n(.*?)^```\n(?:\n```text\n(.*?)^```)?", (REPOSITORY / document).read_text(), re.MULTILINE | re.DOTALL
        )
    )
]


def run(*command, directory):
    environment = os.environ | {"PYTHONPATH": str(EXAMPLES), "MPLBACKEND": "agg"}
    result = subprocess.run([sys.executable, *command], cwd=directory, env=environment, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


@pytest.mark.parametrize(("program", "output"), PROGRAMS)
def test_programs_of_the_documents(program, output, tmp_path):
    printed = run("-c", program, directory=tmp_path)
    assert printed
    assert output in ("", printed)


@pytest.mark.parametrize("name", ["rebound", "backbone", "nonlinear_mode", "wear", "scatter"])
def test_examples_print_what_they_say(name, tmp_path):
    printed = run(str(EXAMPLES / f"{name}.py"), directory=tmp_path).splitlines()
    text = (EXAMPLES / f"{name}.py").read_text()
    assert printed
    assert re.findall(r"^    (.*)$", text.split('"""')[1], re.MULTILINE) == printed


def test_figures_of_the_measured_joint_are_computed(tmp_path):
    file = EXAMPLES / "measured_joint.py"
    printed = run(str(file), str(tmp_path / "curves"), directory=tmp_path)
    paths = tmp_path / "curves", REPOSITORY / "docs" / "measured_joint.csv"
    own, stored = (np.genfromtxt(path, delimiter=",", names=True) for path in paths)
    assert own.dtype == stored.dtype
    for name in own.dtype.names:  # by least squares, rounded to 7 digits
        np.testing.assert_allclose(own[name], stored[name], rtol=1e-5)
    page = (REPOSITORY / "docs" / "validation.md").read_text()
    section = page.partition("## A measured joint")[2].partition("\n## ")[0]
    assert printed.partition("\n\n")[0] in section
    figures = [set(re.findall(r"\d+(?:\.\d+)?", text)) for text in (section, printed + file.read_text().split('"""')[1])]
    assert figures[0] <= figures[1], figures[0] - figures[1]


def test_the_blades_of_the_demonstration_are_those_of_their_program(tmp_path):
    files = REPOSITORY / "fortran_examples" / "model"
    run(str(files / "blade_model.py"), str(tmp_path), directory=tmp_path)
    for file in tmp_path.glob("*.mtx"):
        own, stored = (np.loadtxt(path, skiprows=4) for path in (file, files / file.name))
        # The condition of the stiffness matrix is about 1e6.
        np.testing.assert_allclose(own, stored, rtol=1e-9, atol=1e-9 * np.abs(stored).max())
    assert len(list(tmp_path.glob("*.mtx"))) == 3
