"""What a newcomer sees: names that are understood, texts that fit a screen, nothing of pydantic's."""

from __future__ import annotations

import pydoc
import re
import subprocess
import sys

import pytest

import coaxshell as cx
from coaxshell.apps.cli.template import scenario_text
from coaxshell.errors import InputError
from coaxshell.model import fluids, materials
from coaxshell.model.base import Described

HYBRID = cx.presets.load("hybrid")


@pytest.mark.slow_for("export")
@pytest.mark.parametrize("name", ["plotting", "export"])
def test_rooms_named_in_the_readme_are_there_after_import(name: str) -> None:
    code = f"import sys, coaxshell as cx; assert 'coaxshell.{name}' not in sys.modules; print(cx.{name}.__name__, '{name}' in dir(cx))"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.split() == [f"coaxshell.{name}", "True"]


def test_studies_and_the_paper_import_nothing_slow_before_it_is_used() -> None:
    code = "import sys, coaxshell.studies, coaxshell.apps.paper; print({'scipy.stats', 'xarray', 'matplotlib'} & set(sys.modules))"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.split() == ["set()"]


@pytest.mark.parametrize(("name", "meant"), list(fluids.ALIASES.items()))
def test_fluids_by_the_names_people_use(name: str, meant: str) -> None:
    assert fluids.get(name) is fluids.get(meant)
    assert fluids.get(name.upper()) is fluids.get(meant)


@pytest.mark.parametrize(("name", "meant"), list(materials.ALIASES.items()))
def test_materials_by_the_names_people_use(name: str, meant: str) -> None:
    assert materials.get(name) is materials.get(meant)
    assert cx.Layer(name, "6 mm").material is materials.get(meant)


def test_water_and_steel_in_a_file() -> None:
    text = """
    fluids = ["air", "Water"]
    source = { type = "plane-shock", peak_pressure = "1 kPa", decay_time = "1 ms" }
    [[shells]]
    radius = 1
    layers = [{ material = "steel", thickness = "1 cm" }, { material = "mine", thickness = "1 mm", role = "passive" }]
    [materials.mine]
    density = 1000
    youngs_modulus = "1 GPa"
    poisson_ratio = 0.4
    """
    system = cx.System.from_toml_string(text)
    assert system.fluids[1] == fluids.FRESHWATER
    assert [layer.material.name for layer in system.shells[0].layers] == ["structural-steel", "mine"]
    assert cx.System.from_toml_string(system.to_toml_string()) == system
    assert system.with_overrides({"fluids[1]": "sea water"}).fluids[1] == fluids.SEAWATER
    for name in ("water", "steel"):
        assert name in scenario_text("bare")
    with pytest.raises(InputError, match="did you mean 'steel'"):
        materials.get("stel")


def test_a_material_needs_no_name() -> None:
    mine = cx.Elastic(density=1000, youngs_modulus="1 GPa", poisson_ratio=0.4)
    assert mine.name == "elastic"
    system = HYBRID.replace(absorbers=(), control=None, shells=[cx.Shell(radius=r, layers=[cx.Layer(mine, "5 mm")]) for r in (0.5, 1.0)])
    assert cx.System.from_toml_string(system.to_toml_string()) == system
    assert system.with_overrides({"materials.elastic.density": 2000}).shells[1].layers[0].material.density == 2000
    assert "(name)" in scenario_text("bare").split("elastic:")[1]


def test_two_materials_of_one_name_are_not_changed_as_one() -> None:
    one, two = (cx.Elastic(density=density, youngs_modulus="1 GPa", poisson_ratio=0.4) for density in (1000, 2000))
    system = HYBRID.replace(
        absorbers=(), control=None, shells=[cx.Shell(radius=r, layers=[cx.Layer(m, "5 mm")]) for r, m in ((0.5, one), (1.0, two))]
    )
    with pytest.raises(InputError, match=r"materials\.elastic: is the name of two different materials"):
        system.with_overrides({"materials.elastic.density": 3000})


def test_a_system_is_one_line() -> None:
    text = repr(HYBRID)
    assert text == str(HYBRID)
    assert len(text) < 200
    for words in ("'hybrid'", "2 shells (500.0 mm, 1.000 m)", "25.00 kPa", "25 absorbers", "control"):
        assert words in text
    assert repr(HYBRID.shells[0]) == (
        "Shell(radius=0.5, layers=(Layer(material='PZT-4', thickness=0.003, role='sensor'), "
        "Layer(material='aluminium', thickness=0.006), Layer(material='PZT-4', thickness=0.003, role='actuator')))"
    )
    assert "None" not in repr(cx.presets.load("steel-tube"))


@pytest.mark.parametrize(
    "name", [name for name in cx.__all__ if isinstance(getattr(cx, name), type) and issubclass(getattr(cx, name), Described)]
)
def test_help_and_dir_show_nothing_of_pydantic(name: str) -> None:
    kind = getattr(cx, name)
    text = _help(kind)
    assert len(text.splitlines()) < 100
    assert not re.search(r"model_|object object at|__pydantic|construct|ValidationError|copy\(", text)
    assert not [entry for entry in dir(kind) if entry.startswith("model_")]


def test_dir_of_an_object_is_its_entries_and_verbs() -> None:
    listed = dir(HYBRID)
    assert {"shells", "fluids", "source", "name", "with_overrides", "to_toml", "transit_time"} <= set(listed)
    assert not [name for name in listed if name.startswith(("model_", "_")) or name in ("json", "copy", "construct", "schema")]


def test_help_of_the_package_fits_a_sitting() -> None:
    assert len(_help(cx).splitlines()) < 2900


def _help(thing: object) -> str:
    """Return what ``help`` prints, each signature on one line: from Python 3.13 on a long one takes a line an argument."""
    return re.sub(r"\(\n(?:[ |]+[^ |)][^\n]*\n)+[ |]*\)", "(...)", pydoc.plain(pydoc.render_doc(thing)))


def test_the_plain_steel_tube() -> None:
    system = cx.presets.load("steel-tube")
    assert len(system.shells) == 1
    assert system.shells[0].layers[0].material == materials.STRUCTURAL_STEEL
    assert system.fluids == (fluids.AIR, fluids.FRESHWATER)
    response = cx.simulate("steel-tube", duration=2, time_step=0.02, modes=12)
    assert float(abs(response.stress("shell", 0)).max()) > 1e5
