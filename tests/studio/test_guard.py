"""Only this page's own requests are answered."""

from __future__ import annotations

import hashlib
import stat

import pytest
from asking import KEY, PORT

from coaxshell.apps.studio.guard import kept_key

PAGE = "/"
PUBLISHED = "79542150855a52c567260e3137095dbe2b744e6d702a5cabe67da246942fba7a"
"""SHA-256 of plotly-cartesian.min.js in plotly.js-cartesian-dist-min 4.1.1 of npm, so that nobody changes it by hand."""
WITH_KEY = {"Cookie": "", "Authorization": f"Bearer {KEY}"}


def test_the_page_and_plotly_are_served_from_here(client):
    page = client.get(PAGE)
    assert page.status_code == 200
    assert "coaxshell studio" in page.text
    script = client.get("/vendor/plotly.min.js")
    assert script.headers["content-type"].startswith("text/javascript")
    assert "plotly.js (cartesian - minified) v" in script.text[:200]
    assert hashlib.sha256(script.content).hexdigest() == PUBLISHED


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:8765", "127.0.0.1.evil.example:8765", "127.0.0.1:x", "127.0.0.1@evil", "::1", ""]
)
def test_another_name_for_this_machine_is_refused(client, host):
    answer = client.get(PAGE, headers={"Host": host})
    assert answer.status_code == 403
    assert answer.json()["error"]["where"] == "Host"


@pytest.mark.parametrize("host", ["localhost:8765", "LOCALHOST:8765", "localhost:9000", "127.0.0.1", "[::1]:9000", "lab.example.org"])
def test_this_machine_is_known_by_its_names_whatever_port_a_tunnel_starts_from(client, host):
    assert client.get("/api/jobs?client=a", headers={**WITH_KEY, "Host": host, "Origin": f"http://{host}"}).status_code == 200


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:8766", "ftp://127.0.0.1:8765", "http://127.0.0.1"])
def test_another_origin_is_refused(client, origin):
    answer = client.get(PAGE, headers={"Origin": origin})
    assert answer.status_code == 403
    assert answer.json()["error"]["where"] == "Origin"


@pytest.mark.parametrize(("site", "status"), [("cross-site", 403), ("same-site", 403), ("same-origin", 200), ("none", 200)])
def test_requests_that_another_site_has_caused_are_refused(client, site, status):
    assert client.get(PAGE, headers={"Sec-Fetch-Site": site}).status_code == status


NAVIGATION = {"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Mode": "navigate", "Sec-Fetch-Dest": "document"}


def test_a_link_on_another_site_leads_to_the_page_and_to_nothing_else(client):
    assert "coaxshell studio" in client.get(PAGE, headers=NAVIGATION).text
    assert client.get("/api/schema", headers=NAVIGATION).status_code == 403
    assert client.post(PAGE, headers=NAVIGATION).status_code == 403
    for changed in ({"Sec-Fetch-Dest": "iframe"}, {"Sec-Fetch-Mode": "no-cors"}, {"Sec-Fetch-Dest": "image"}):
        assert client.get(PAGE, headers={**NAVIGATION, **changed}).status_code == 403


PLACES = ["/api/schema", "/api/jobs?client=a", "/api/events?client=a", "/page/js/main.js", "/vendor/plotly.min.js", "/nothing"]


@pytest.mark.parametrize("cookie", ["", "x=1", *(f"coaxshell-{PORT}={wrong}" for wrong in ("", "wrong", KEY[:-1], KEY + "x", "\xe9"))])
def test_who_does_not_have_the_key_is_not_answered(client, cookie):
    stranger = {"Cookie": cookie.encode("latin-1")}
    for path in PLACES:
        answer = client.get(path, headers=stranger)
        assert (answer.status_code, answer.json()["error"]["code"]) == (401, "no-key"), path
    assert client.post("/api/studies", json={"client": "a"}, headers=stranger).status_code == 401
    page = client.get(PAGE, headers=stranger)
    assert page.status_code == 401
    assert "has printed in its terminal" in page.text
    assert "script" not in page.text


@pytest.mark.parametrize("given", ["wrong", KEY[:-1], KEY.upper(), "%00", "%ff"])
def test_a_wrong_key_in_the_address_opens_nothing(client, given):
    answer = client.get(f"/?key={given}", headers={"Cookie": ""}, follow_redirects=False)
    assert answer.status_code == 401
    assert "set-cookie" not in answer.headers


def test_the_address_with_the_key_gives_a_cookie_and_leads_to_one_without(client):
    answer = client.get(f"/?key={KEY}", headers={"Cookie": ""}, follow_redirects=False)
    assert (answer.status_code, answer.headers["location"]) == (303, "/")
    name, *rest = answer.headers["set-cookie"].split("; ")
    assert name == f"coaxshell-{PORT}={KEY}"
    assert {"HttpOnly", "SameSite=lax", "Path=/"} <= set(rest)


def test_programs_may_send_the_key_in_a_header(client):
    assert client.get("/api/schema", headers=WITH_KEY).status_code == 200
    assert client.get("/api/schema", headers={**WITH_KEY, "Authorization": f"Bearer {KEY}x"}).status_code == 401


def test_the_key_is_kept_where_only_its_owner_reads_it(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    key = kept_key()
    path = tmp_path / "coaxshell" / "studio-key"
    assert (path.read_text(), stat.S_IMODE(path.stat().st_mode)) == (key, 0o600)
    assert kept_key() == key
    path.chmod(0o644)  # others may have read it
    fresh = kept_key()
    assert fresh != key
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    path.write_text("short")
    assert len(kept_key()) > 20
    monkeypatch.setenv("XDG_STATE_HOME", "/proc/nowhere")
    assert kept_key() not in (key, fresh), "a key for this time only"


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
