"""``coaxshell.sensitivity`` and ``coaxshell.robustness`` against functions whose indices and percentiles are known exactly."""

from __future__ import annotations

import math

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose
from scipy.special import ndtri
from scipy.stats import truncnorm

import coaxshell as cx
from coaxshell.studies import Execution, OptimisationStudy, optimise_problem, read_study, running
from coaxshell.studies.evaluation import Outcome, failure
from coaxshell.studies.uncertainty.distributions import coordinates_of, uncertain_of
from coaxshell.studies.uncertainty.statistics import statistic

STRESS = ["inner.peak_stress"]
TWO = {"source.peak_pressure": [1e4, 3e4], "source.distance": [4.0, 6.0]}


@pytest.fixture
def bare():
    return cx.presets.load("bare")


@pytest.fixture
def stand_in(monkeypatch):
    """Replace the runs by a function of the system."""

    def replaced(function):
        def run_cases(systems, metrics, *unused):
            return [
                failure(metrics, str(one)) if isinstance(one, cx.InputError) else Outcome((function(one),) * len(metrics))
                for one in systems
            ]

        monkeypatch.setattr(running, "run_cases", run_cases)

    return replaced


@pytest.mark.parametrize(("samples", "finer"), [(1024, 16.0), pytest.param(4096, 1.0, marks=pytest.mark.slow)], ids=["few", "many"])
def test_the_ishigami_function(bare, stand_in, samples, finer):
    """sin x1 + 7 sin^2 x2 + x3^4 sin x1 / 10, x uniform over -pi to pi; T. Ishigami, T. Homma, ISUMA (1990) 398-403."""
    a, b = 7.0, 0.1

    def ishigami(system):
        x, y, z = system.control.proportional, system.control.derivative, system.source.angle * math.pi / 180.0
        return math.sin(x) + a * math.sin(y) ** 2 + b * z**4 * math.sin(x)

    stand_in(ishigami)
    system = cx.presets.load("active")
    ends = [-math.pi, math.pi]
    over = {"control.proportional": ends, "control.derivative": {"from": ends[0], "to": ends[1]}, "source.angle": cx.Uniform(-180, 180)}
    found = cx.sensitivity(system, over, STRESS, samples=samples)
    variance = a**2 / 8 + b * math.pi**4 / 5 + b**2 * math.pi**8 / 18 + 0.5
    first = np.array([0.5 * (1 + b * math.pi**4 / 5) ** 2, a**2 / 8, 0.0]) / variance
    crossed = 8 * b**2 * math.pi**8 / 225 / variance
    total = first + np.array([crossed, 0.0, crossed])
    for name, exact in (("first_order", first), ("total_order", total)):
        value, low, high = found[name].sel(metric=STRESS[0]).to_numpy().T
        assert_allclose(value, exact, rtol=0, atol=3e-3 * finer)
        assert (low <= exact + 1e-3 * finer).all()
        assert (high >= exact - 1e-3 * finer).all()
    statistics = found[STRESS[0]].sel(estimate="value")
    assert_allclose(float(statistics.sel(statistic="mean")), a / 2, rtol=5e-5 * finer)
    assert_allclose(float(statistics.sel(statistic="deviation")), math.sqrt(variance), rtol=2e-4 * finer)


EXACT = np.array([1.0, 0.1, 1 + 0.1 * ndtri(0.05), 1.0, 1 + 0.1 * ndtri(0.95)])
"""Mean, deviation, 5th, 50th and 95th percentile of a normal factor about 1 with a deviation of 0.1."""


def test_stress_is_proportional_to_the_peak_pressure(bare, quick):
    """In a linear system the peak stress is S p/p0: its statistics are those of p."""
    nominal = cx.simulate(bare, **quick).summary().shells[0].stress.value
    uncertain = {"source.peak_pressure": {"normal": {"mean": 1.0, "deviation": 0.1}, "relative": True}}
    found = cx.robustness(bare, uncertain, [*STRESS, "absorbers.mass"], samples=64, workers=1, **quick)
    value, low, high = found[STRESS[0]].to_numpy().T / nominal
    assert_allclose(value, EXACT, rtol=0, atol=0.012)  # 64 points leave the 5th percentile open by about a point's distance
    assert_allclose(value[[0, 3]], 1.0, rtol=0, atol=2e-3)
    assert ((low <= EXACT) & (high >= EXACT)).all()
    assert found[STRESS[0]].attrs["units"] == "Pa"
    factors = found["source.peak_pressure"].to_numpy()
    assert_allclose(found["runs.inner.peak_stress"], nominal * factors, rtol=1e-9)
    assert_allclose(value[4], np.quantile(factors, 0.95), rtol=1e-9)
    assert (found["absorbers.mass"] == 0.0).all()


def test_statistics_converge_to_the_exact_ones(bare, stand_in):
    stand_in(lambda system: system.source.peak_pressure / bare.source.peak_pressure)
    found = cx.robustness(bare, {"source.peak_pressure": {"relative": 0.1}}, STRESS, samples=4096)
    assert_allclose(found[STRESS[0]].sel(estimate="value"), EXACT, rtol=0, atol=5e-4)


COARSE = {"duration": 0.4, "time_step": 0.1, "modes": 2}
"""Of what is exact at any resolution."""


def test_indices_of_a_linear_system_through_real_runs():
    """S p with p uniform, and a gain of a volt a metre, which is nothing: all variance is the pressure's."""
    over = {"source.peak_pressure": [1e4, 3e4], "control.proportional": [-1.0, 1.0]}
    found = cx.sensitivity(cx.presets.load("active"), over, [*STRESS, "absorbers.mass"], samples=32, workers=1, **COARSE)
    assert found.sizes["case"] == 32 * 4
    first, total = (found[name].sel(metric=STRESS[0], estimate="value").to_numpy() for name in ("first_order", "total_order"))
    assert_allclose(first, [1.0, 0.0], rtol=0, atol=0.05)
    assert_allclose(total, [1.0, 0.0], rtol=0, atol=0.05)
    assert abs(total[1]) < 1e-10
    assert found["first_order"].sel(metric="absorbers.mass").isnull().all()  # it does not vary


def test_seeds_repeat_and_differ(bare, stand_in):
    stand_in(lambda system: system.source.peak_pressure * system.source.distance)
    first, again, other = (cx.sensitivity(bare, TWO, STRESS, samples=16, seed=seed) for seed in (3, 3, 4))
    xr.testing.assert_identical(first, again)
    assert not np.array_equal(first["source.distance"], other["source.distance"])
    drawn = [cx.robustness(bare.with_overrides({"source.angle": angle}), TWO, STRESS, samples=16) for angle in (0, 30)]
    np.testing.assert_array_equal(drawn[0]["source.distance"], drawn[1]["source.distance"])  # two designs meet the same conditions


@pytest.mark.slow
def test_resumed_equals_uninterrupted(bare, quick, tmp_path):
    options = {"samples": 8, "workers": 1, **quick}
    whole = cx.sensitivity(bare, TWO, STRESS, store=tmp_path / "store", **options)
    cases = sorted(path for path in (tmp_path / "store").glob("*.json") if path.name != "study.json")
    assert len(cases) == 32
    for path in cases[::2]:
        path.unlink()
    resumed = cx.sensitivity(bare, TWO, STRESS, store=tmp_path / "store", resume=True, **options)
    xr.testing.assert_identical(whole, resumed)
    with pytest.raises(cx.InputError, match="samples and seed differ"):
        cx.sensitivity(bare, TWO, STRESS, store=tmp_path / "store", resume=True, **{**options, "seed": 1})


def test_a_failed_run_is_told_and_never_left_out(bare, stand_in, quick):
    stand_in(lambda system: system.source.peak_pressure)
    uncertain = {"shells[0].radius": [0.5, 1.2], "source.peak_pressure": {"relative": 0.1}}
    with pytest.warns(cx.PhysicsWarning, match=r"of 16 cases failed .* there are no statistics, which the other runs alone would bias"):
        found = cx.robustness(bare, uncertain, STRESS, samples=16)
    assert found[STRESS[0]].isnull().all()
    failed = found["failure"] != ""
    assert 0 < int(failed.sum()) < 16
    np.testing.assert_array_equal(failed, found["runs.inner.peak_stress"].isnull())


def test_no_impossible_value_is_drawn(bare):
    """A normal distribution is cut off at the field's limit and scaled up: that of scipy's truncnorm."""
    uncertain = uncertain_of(bare, {"source.distance": {"normal": ["5 m", "1.6 m"]}}, 8, 0)
    (coordinate,) = uncertain.coordinates
    low = coordinate.limits(5.0)[0]
    shares = np.array([0.0, 1e-6, 0.3, 0.5, 0.99, 1.0])
    found = [coordinate.quantile(share, 5.0) for share in shares]
    assert_allclose(found[1:5], truncnorm.ppf(shares[1:5], (low - 5) / 1.6, np.inf, 5, 1.6), rtol=1e-10)
    assert np.isfinite(found).all()
    assert min(found) > low


def test_laws(bare):
    given = {
        "source.distance": {"lognormal": {"median": "5 m", "factor": 1.1}},
        "source.peak_pressure": {"uniform": {"from": "10 kPa", "to": "40 kPa", "scale": "log"}},
        "source.decay_time": {"relative": 0.1},
    }
    distance, pressure, time = coordinates_of(bare, given, "uncertain")
    assert_allclose(distance.quantile(0.5, 5.0), 5.0, rtol=1e-12)
    assert_allclose(distance.quantile(0.8413447460685429, 5.0), 5.5, rtol=1e-9)
    assert_allclose(pressure.quantile(0.5, 1.0), 2e4, rtol=1e-9)
    assert_allclose(pressure.distribution.share(2e4), 0.5, rtol=1e-12)
    assert_allclose(time.quantile(0.05, 1.3e-4), 1 + 0.1 * ndtri(0.05), rtol=1e-9)
    assert time.distribution == cx.Normal(1.0, 0.1, relative=True)
    assert statistic("worst", np.array([1.0, 5.0, 2.0])) == 5.0
    assert_allclose(statistic("p95", np.arange(101.0)), 95.0, rtol=1e-12)


@pytest.mark.parametrize(
    ("over", "options", "message"),
    [
        ({"source.peak_presure": [1, 2]}, {}, r"over\.source\.peak_presure: .*did you mean 'peak_pressure'"),
        ({"source.distance": {"nomral": [1, 2]}}, {}, r"over\.source\.distance: .* is not a distribution"),
        ({"source.distance": 5}, {}, "5 is not a distribution"),
        ({"source.distance": {"normal": {"mean": 5}}}, {}, r"over\.source\.distance\.normal\.deviation: is missing"),
        ({"source.distance": {"normal": {"mean": 5, "sigma": 1}}}, {}, r"normal\.sigma: is not an entry"),
        ({"source.distance": {"normal": [5, -1]}}, {}, "a standard deviation of -1.0 is not allowed"),
        ({"source.distance": {"relative": 0}}, {}, "a standard deviation of 0.0 is not allowed"),
        ({"source.distance": {"uniform": ["4 kg", 5]}}, {}, r"over\.source\.distance\.from: '4 kg' is not a length"),
        ({"source.distance": [6, 4]}, {}, "the range from 6.0 to 4.0 is empty"),
        ({"source.distance": {"from": 0, "to": 5, "scale": "log"}}, {}, "0.0 has no logarithm"),
        ({"source.decay_time": [-1e-4, 1e-4]}, {}, r"over\.source\.decay_time: -0.0001 s is not allowed"),
        ({"source.decay_time": {"normal": [1e-4, 1e-4]}}, {}, "% of this distribution are values that are not allowed"),
        ({"source.distance": {"lognormal": [5, 0.9]}}, {}, "the factor than 1"),
        ({"source.angle": {"relative": 0.1}}, {}, "its nominal value is 0"),
        ({"absorbers": [1, 2]}, {}, "is not a real number"),
        ({"source.distance": [4, 5]}, {}, "only one property is uncertain"),
        ({}, {}, "over: there are none"),
        (TWO, {"samples": 100}, "samples: 100 is not a power of two.*such as 128"),
        (TWO, {"samples": 4}, "samples: 4 is not allowed"),
        (TWO, {"samples": None}, "samples: None is not allowed"),
        (TWO, {"seed": -1}, "seed: -1 is not allowed"),
        (TWO, {"confidence": 95}, "confidence: 95 is not allowed"),
        (TWO, {"metrics": ["inner.peak"]}, "'inner.peak' is not a known metric"),
        (TWO, {"modes": 0}, "modes: 0 is not allowed"),
    ],
)
def test_bad_studies(bare, quick, over, options, message, tmp_path):
    with pytest.raises(cx.InputError, match=message):
        cx.sensitivity(bare, over, **{"metrics": STRESS, "samples": 8, "workers": 1, "store": tmp_path / "store", **quick, **options})
    assert not (tmp_path / "store").exists()


def test_a_robust_objective_of_a_study_file_is_the_statistic_of_robustness(tmp_path, quick):
    (tmp_path / "study.toml").write_text(
        """
        scenario = "absorbers"
        objectives = ["p95(inner.peak_stress)"]
        samples = 8
        evaluations = 4
        population = 4
        seed = 5
        variables.absorbers.mass = { from = 5, to = 20 }
        [uncertain]
        source.peak_pressure = { relative = 0.1 }
        absorbers.damping = { uniform = [0.5, 2], relative = true }
        [resolution]
        duration = 1.0
        time_step = 0.02
        modes = 6
        """
    )
    found = optimise_problem(read_study(tmp_path / "study.toml", OptimisationStudy).problem(tmp_path), Execution(workers=1))
    uncertain = {"source.peak_pressure": {"relative": 0.1}, "absorbers.damping": cx.Uniform(0.5, 2, relative=True)}
    same = cx.robustness(found.system, uncertain, STRESS, samples=8, seed=5, workers=1, **quick)
    expected = float(same[STRESS[0]].sel(statistic="p95", estimate="value"))
    assert_allclose(found.best.targets["p95(inner.peak_stress)"], expected, rtol=1e-12)
