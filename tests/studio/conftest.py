"""One application for all tests of a process: its workers take seconds to start."""

from __future__ import annotations

import pytest
from starlette.testclient import TestClient

from coaxshell.studio.app import create_app

PORT = 8765


@pytest.fixture(scope="session")
def client():
    with TestClient(create_app(PORT), base_url=f"http://127.0.0.1:{PORT}") as client:
        yield client
