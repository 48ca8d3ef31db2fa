"""One application for all tests of a process: its workers take seconds to start."""

from __future__ import annotations

import pytest
from asking import KEY, PORT
from starlette.testclient import TestClient

from coaxshell.apps.studio.app import create_app


@pytest.fixture(scope="session")
def client():
    app = create_app(PORT, KEY, ("lab.example.org",))
    with TestClient(app, base_url=f"http://127.0.0.1:{PORT}", cookies={f"coaxshell-{PORT}": KEY}) as client:
        yield client
