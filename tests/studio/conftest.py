"""One application for all tests of a process: its workers take seconds to start."""

from __future__ import annotations

from pathlib import Path

import pytest
from asking import KEY, PORT
from starlette.testclient import TestClient

from coaxshell.apps.studio.app import create_app

HERE = Path(__file__).parent


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """Keep these in one test process and those of the browser in another, since servers take seconds to start: before xdist reads it."""
    for item in items:
        if HERE in item.path.parents:
            item.add_marker(pytest.mark.xdist_group("browser" if HERE / "browser" in item.path.parents else "studio"))


@pytest.fixture(scope="session")
def client():
    app = create_app(PORT, KEY, ("lab.example.org",))
    with TestClient(app, base_url=f"http://127.0.0.1:{PORT}", cookies={f"coaxshell-{PORT}": KEY}) as client:
        yield client
