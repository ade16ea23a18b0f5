"""The stubs that editors read against the package that runs: the same names, the same signatures, the same keys."""

import ast
import inspect
import pathlib

import numpy as np
import pytest

import rotor_hhc

STUBS = ast.parse((pathlib.Path(__file__).resolve().parents[1] / "rotor_hhc.pyi").read_text())
FUNCTIONS = {node.name: node for node in STUBS.body if isinstance(node, ast.FunctionDef)}
CLASSES = {node.name: node for node in STUBS.body if isinstance(node, ast.ClassDef)}
TABLES = {
    name: [line.target.id for line in node.body if isinstance(line, ast.AnnAssign)]
    for name, node in CLASSES.items()
    if [getattr(base, "id", "") for base in node.bases] == ["TypedDict"]
}
KINDS = {name: node for name, node in CLASSES.items() if name not in TABLES}
VALUES = [node.target.id for node in STUBS.body if isinstance(node, ast.AnnAssign)]


def public(names):
    return {name for name in names if not name.startswith("_")}


def parameters(node, without_self=False):
    """Name, kind and default of every parameter of a stub."""
    given = node.args.posonlyargs + node.args.args
    defaults = [None] * (len(given) - len(node.args.defaults)) + list(node.args.defaults)
    kind = inspect.Parameter
    all_of = [(own.arg, kind.POSITIONAL_OR_KEYWORD, default) for own, default in zip(given, defaults)]
    named = zip(node.args.kwonlyargs, node.args.kw_defaults)
    all_of += [(own.arg, kind.KEYWORD_ONLY, default) for own, default in named]
    read = [(name, kind, "none" if value is None else ast.literal_eval(value)) for name, kind, value in all_of]
    return read[1:] if without_self else read


def own_parameters(function):
    """The same of what runs; a tuple and a list are as good as one another for a default."""
    found = []
    for own in inspect.signature(function).parameters.values():
        default = "none" if own.default is inspect.Parameter.empty else own.default
        if own.name != "self":
            found.append((own.name, own.kind, tuple(default) if isinstance(default, list) else default))
    return found


def test_every_public_name_is_on_both_sides():
    here = public(name for name, value in vars(rotor_hhc).items() if not inspect.ismodule(value))
    assert here == public(FUNCTIONS) | public(KINDS) | public(VALUES)
    assert {"__version__"} == set(VALUES) - public(VALUES)
    assert len(FUNCTIONS) > 7 and len(KINDS) > 5, "the stubs were not read"


@pytest.mark.parametrize("name", sorted(FUNCTIONS))
def test_a_function_has_the_signature_of_its_stub(name):
    assert own_parameters(getattr(rotor_hhc, name)) == parameters(FUNCTIONS[name])


@pytest.mark.parametrize("name", sorted(KINDS))
def test_a_class_has_the_members_of_its_stub(name):
    kind = getattr(rotor_hhc, name)
    said = [getattr(base, "id", "") for base in KINDS[name].bases]
    assert [base.__name__ for base in kind.__bases__] == (said or ["object"])
    methods = {node.name: node for node in KINDS[name].body if isinstance(node, ast.FunctionDef)}
    set_later = {node.target.id for node in KINDS[name].body if isinstance(node, ast.AnnAssign)}
    inherited = set(dir(kind.__bases__[0]))
    assert public(dir(kind)) - inherited == public(methods), "set later: " + ", ".join(set_later)
    for method, node in methods.items():
        marks = {getattr(mark, "id", "") for mark in node.decorator_list}
        own = inspect.getattr_static(kind, method)
        if "property" in marks:
            assert inspect.isgetsetdescriptor(own), method
            continue
        is_static = "staticmethod" in marks
        assert isinstance(own, staticmethod) == is_static, method
        assert own_parameters(getattr(kind, method)) == parameters(node, not is_static), method


def test_answers_have_the_keys_of_their_stubs():
    still = np.zeros(4)
    answers = {
        "SectionAmplitudes": rotor_hhc.section_response(0.1),
        "SectionHistory": rotor_hhc.section_history(0.5, still, still),
        "Modes": rotor_hhc.modes(),
        "Trim": rotor_hhc.trim(inflow="uniform"),
        "TMatrix": rotor_hhc.t_matrix(harmonics=3, inflow="uniform"),
    }
    assert answers.keys() == TABLES.keys()
    for name, answer in answers.items():
        assert sorted(answer) == sorted(TABLES[name]), name
