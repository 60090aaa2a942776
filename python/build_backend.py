"""The build backend: maturin's, which fetches a toolchain of Rust if it finds no other. Here the user is told what is missing."""

import shutil
import sys

if not shutil.which("cargo"):
    sys.exit(
        "microslip is built by cargo, which is not on PATH: install Rust 1.88 or later (https://rustup.rs), or install a wheel."
    )

from maturin import *  # noqa: F403
