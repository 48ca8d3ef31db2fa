"""Only this page's own requests are answered."""

from __future__ import annotations

import pytest

PAGE = "/"


def test_the_page_and_plotly_are_served_from_here(client):
    page = client.get(PAGE)
    assert page.status_code == 200
    assert "coaxshell studio" in page.text
    script = client.get("/vendor/plotly.min.js")
    assert script.headers["content-type"].startswith("text/javascript")
    assert "plotly.js v" in script.text[:200]


@pytest.mark.parametrize("host", ["evil.example", "evil.example:8765", "127.0.0.1", "127.0.0.1:80", "127.0.0.1.evil.example:8765", ""])
def test_another_name_for_this_machine_is_refused(client, host):
    answer = client.get(PAGE, headers={"Host": host})
    assert answer.status_code == 403
    assert answer.json()["error"]["where"] == "Host"


def test_localhost_is_a_name_of_this_machine(client):
    assert client.get(PAGE, headers={"Host": "localhost:8765"}).status_code == 200


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:8766", "https://127.0.0.1:8765", "http://127.0.0.1"])
def test_another_origin_is_refused(client, origin):
    answer = client.get(PAGE, headers={"Origin": origin})
    assert answer.status_code == 403
    assert answer.json()["error"]["where"] == "Origin"


@pytest.mark.parametrize(("site", "status"), [("cross-site", 403), ("same-site", 403), ("same-origin", 200), ("none", 200)])
def test_requests_that_another_site_has_caused_are_refused(client, site, status):
    assert client.get(PAGE, headers={"Sec-Fetch-Site": site}).status_code == status


def test_every_answer_keeps_the_page_to_itself(client):
    for answer in (client.get(PAGE), client.get("/nothing"), client.get(PAGE, headers={"Host": "evil"})):
        policy = answer.headers["content-security-policy"]
        assert "default-src 'none'" in policy
        assert "script-src 'self';" in policy
        assert "http" not in policy
        assert answer.headers["x-content-type-options"] == "nosniff"


@pytest.mark.parametrize("path", ["/page/../app.py", "/page/..%2fapp.py", "/page/%2e%2e/app.py", "/page//etc/passwd", "/page/..%5capp.py"])
def test_only_the_files_of_the_page_are_served(client, path):
    assert client.get(path).status_code == 404
