"""What becomes of the jobs of a page that is closed or loaded anew."""

from __future__ import annotations

import asyncio

import pytest
from asking import SMALL, described, ended, reporting, shared_worker

from coaxshell.apps.studio.jobs import CANCELLED, DONE, ENDED, RUNNING, Job, Jobs

PAGE, OTHER = "page", "other"


@pytest.fixture(scope="module")
def carried_out():
    with shared_worker() as told:
        yield told


def busy(jobs, kind, client=PAGE, seconds=20.0):
    return jobs.start(Job(client, kind), reporting, seconds)


def gone(jobs, client=PAGE):
    """Let a page come and go."""
    jobs.unwatch(client, jobs.watch(client))


async def until(holds, seconds=60.0):
    end = asyncio.get_running_loop().time() + seconds
    while not holds():
        assert asyncio.get_running_loop().time() < end
        await asyncio.sleep(0.01)


@pytest.mark.parametrize("kind", ["solve", "field", "film"])
def test_what_only_a_page_that_has_gone_would_show_is_stopped(kind, carried_out):
    async def story(crew):
        jobs = Jobs(crew)
        running, waiting = busy(jobs, kind), busy(jobs, "field")
        gone(jobs)
        await until(lambda: {running.state, waiting.state} == {CANCELLED})
        after = busy(jobs, "solve", OTHER, 0.0)
        await until(lambda: after.state in ENDED)
        return after.state

    assert carried_out(story, GONE_SECONDS=0.05) == DONE


def comes_back(jobs):
    gone(jobs)
    jobs.watch(PAGE)


def closes_one_of_two_windows(jobs):
    jobs.watch(PAGE)
    gone(jobs)


def is_another(jobs):
    gone(jobs, OTHER)


@pytest.mark.parametrize("page", [comes_back, closes_one_of_two_windows, is_another])
def test_jobs_go_on_when_their_page(page, carried_out):
    async def story(crew):
        jobs = Jobs(crew)
        job = busy(jobs, "field", seconds=1.0)
        page(jobs)
        await until(lambda: job.state in ENDED)
        return job.state

    assert carried_out(story, GONE_SECONDS=0.05) == DONE


def test_the_studies_of_a_program_that_never_watched_are_its_own(carried_out):
    async def story(crew):
        jobs = Jobs(crew)
        study = busy(jobs, "sweep", "program", 0.0)
        gone(jobs)
        await until(lambda: study.state in ENDED)
        return study.state, jobs.take_over(OTHER)

    assert carried_out(story, GONE_SECONDS=0.05) == (DONE, [])


@pytest.mark.parametrize("kind", ["sweep", "optimise"])
def test_studies_go_on_and_another_page_takes_them_over(kind, carried_out):
    async def story(crew):
        jobs = Jobs(crew)
        study = busy(jobs, kind)
        jobs.watch(OTHER)
        assert jobs.take_over(OTHER) == []  # its page is still there, or may never have been one
        gone(jobs)
        await asyncio.sleep(0.2)
        await until(lambda: study.state == RUNNING)
        watcher = jobs.watch(OTHER)
        watcher.clear()
        assert jobs.take_over(OTHER) == [study]
        assert (study.client, jobs.of(PAGE), watcher.is_set()) == (OTHER, [], True)
        assert jobs.take_over("third") == []
        jobs.cancel(study)
        gone(jobs, OTHER)
        return jobs.take_over("third")

    assert carried_out(story, GONE_SECONDS=0.05) == []  # it was cancelled


def test_a_study_taken_over_by_a_page_that_vanishes_is_left_for_the_next(carried_out):
    async def story(crew):
        jobs = Jobs(crew)
        study = busy(jobs, "sweep")
        gone(jobs)
        assert jobs.take_over(OTHER) == [study]  # which never opens its stream
        taken = jobs.take_over("third")
        jobs.cancel(study)
        return taken == [study], study.client

    assert carried_out(story) == (True, "third")


def test_the_route(client):
    assert client.post("/api/studies", json={"client": "tab"}).json() == {"jobs": []}
    assert client.post("/api/studies", json={}).json()["error"]["where"] == "client"


def test_a_title_is_kept_and_one_too_long_is_refused(client):
    def asked(title):
        entries = {"kind": "sweep", "over": {"absorbers.mass": [1.0]}, "system": described("absorbers"), "resolution": SMALL}
        return client.post("/api/jobs", json={"client": "tab", "title": title, **entries})

    assert ended(client, asked("mass <b>& all</b>").json()["job"])["title"] == "mass <b>& all</b>"
    for bad in ("x" * 201, 7, None, ["a"]):
        assert (asked(bad).status_code, asked(bad).json()["error"]["where"]) == (400, "title")
