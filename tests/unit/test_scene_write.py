"""Any scene survives being written as TOML and read again; anything else gives a SceneError and nothing worse."""

import tomllib
from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from contact1d.workflow.scene import Scene, SceneError, scene_from_dict, scene_to_toml


def base(**tables: Any) -> dict[str, Any]:
    """A small good scene as a dict, with other tables."""
    bodies = {
        "particles": "auto",
        "spacing": 1.0,
        "profile": {"kind": "parabola", "radius": 10.0},
        "bulk_stiffness": 1.0,
    }
    repulsion = {"amplitude": 1.0, "range": 0.5}
    scene = {"title": "base", "bodies": bodies, "interaction": {"repulsion": repulsion}}
    return {**scene, "experiment": {"kind": "load", "force": 1.0}, **tables}


sizes = st.floats(1e-6, 1e6)
auto = st.just("auto")
titles = st.text(min_size=1, max_size=40).filter(lambda text: bool(text.strip()) and text.isprintable())
numbers = st.floats(-1e6, 1e6)
methods = st.sampled_from(["quasistatic", "dynamic"])
spans = st.fixed_dictionaries(
    {"from": numbers, "to": numbers, "steps": st.integers(1, 1000)}, optional={"return": st.booleans()}
).filter(lambda span: span["from"] != span["to"])
laws = st.fixed_dictionaries(
    {"repulsion": st.fixed_dictionaries({"amplitude": sizes, "range": st.floats(0.1, 1)})},
    optional={"cutoff": auto | sizes},
)
all_bodies = st.fixed_dictionaries(
    {
        "particles": auto | st.integers(3, 10**7),
        "spacing": sizes | st.integers(1, 9),
        "profile": st.fixed_dictionaries({"kind": st.just("parabola"), "radius": sizes}),
        "bulk_stiffness": sizes,
    },
    optional={"bulk_stiffness_tangential": sizes, "mass": sizes},
)
neighbours = {"neighbours": st.fixed_dictionaries({"stiffness": sizes})}
horizontal = {"horizontal": st.just({})}
in_time = {
    "damping": st.fixed_dictionaries({"coefficient": auto | sizes}),
    "plate": st.fixed_dictionaries(
        {"free": st.permutations(["x", "z"])}, optional={"mass": auto | sizes, "damping": auto | st.just(0) | sizes}
    ),
    "cantilever": st.fixed_dictionaries({"stiffness": sizes, "velocity": sizes}),
}
noises = st.fixed_dictionaries({"temperature": sizes, "seed": st.integers(1, 2**31 - 1)})
displacements = spans | st.lists(numbers, min_size=1, max_size=20)
still = st.fixed_dictionaries(
    {"experiment": st.fixed_dictionaries({"kind": st.just("path"), "displacements": displacements})},
    optional=neighbours | horizontal,
)
moving = st.fixed_dictionaries(
    {
        "experiment": st.fixed_dictionaries({"kind": st.just("slide"), "normal_force": sizes, "distance": sizes}),
        **horizontal,
        **in_time,
    },
    optional={**neighbours, "noise": noises, "accuracy": st.fixed_dictionaries({"tolerance": st.floats(1e-7, 0.1)})},
)


@given(title=titles, bodies=all_bodies, law=laws, rest=still | moving)
def test_every_scene_survives_being_written_and_read(title: str, bodies: Any, law: Any, rest: Any) -> None:
    scene = scene_from_dict({"title": title, "bodies": bodies, "interaction": law, **rest})
    again = scene_from_dict(tomllib.loads(scene_to_toml(scene)))
    assert again == scene
    assert isinstance(again, Scene)
    assert (again.method, again.effects) == (scene.method, scene.effects)


garbage = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8) | st.sampled_from(["auto", "load"]),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(
            st.sampled_from(
                ["kind", "knid", "particles", "free", "from", "to", "repulsion", "table", "list", "load", "path"]
            )
            | st.text(max_size=5),
            inner,
            max_size=4,
        )
    ),
    max_leaves=8,
)
places = ["title", "bodies", "bodies.profile", "interaction", "interaction.repulsion", "plate", "experiment", "zzz"]
places += ["bodies.particles", "experiment.kind", "experiment.displacements", "experiment.displacements.from"]


@given(changes=st.dictionaries(st.sampled_from(places), garbage, max_size=4))
def test_whatever_is_written_gives_a_scene_or_a_scene_error(changes: dict[str, Any]) -> None:
    data = base(experiment={"kind": "path", "displacements": [0.0, 1.0]})
    for path, value in changes.items():
        *above, last = path.split(".")
        table: Any = data
        for key in above:
            table = table.get(key) if isinstance(table, dict) else None
        if isinstance(table, dict):
            table[last] = value
    try:
        scene_from_dict(data)
    except SceneError as error:
        assert error.problems
        assert "\n" not in "".join(map(str, error.problems))
