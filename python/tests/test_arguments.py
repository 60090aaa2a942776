"""Whatever the arguments, a call returns or raises an error that names one of them, and changes nothing else."""

from __future__ import annotations

import contextlib
import copy
import enum
import inspect
import os
import pickle
import re
import threading
import warnings

import microslip
import numpy as np
import pytest
from microslip import _contact, _core, _element, _law, _memory
from tables import ELLIPSE, FLAT, HEADER, REPOSITORY

contact = microslip.Contact(**FLAT)
element = microslip.Element(**FLAT)
contacts = microslip.ContactArray([contact, contact])
elements = microslip.ElementArray([element, element])
workspace = microslip.Workspace(1, 8)
element_workspace = microslip.ElementWorkspace(1, 1, 8)
state = microslip.State()
element_state = microslip.ElementState()
SLIP = contact.slip_displacement
TIME = np.linspace(0, 4 * np.pi, 160)
LOOP = 2 * SLIP * np.cos(TIME), contact.update(state, 2 * SLIP * np.cos(TIME)).force
LAYER = {"normal_compliance": 0.0, "tangential_compliance": 0.0, "stiffening_load": 100.0, "reference_load": 50.0}
DIRECTIONS = {"directions": 1, "normal_input": "approach"}
MANY = {"index": [0, 1], "active": [1, 1]}


def valid():
    """Valid arguments of every public function, by name. Those that a call may change are new."""
    out, element_out = microslip.State(), microslip.ElementState()
    return {
        "status_text": {"status": 1},
        "fit": {"loops": [LOOP], "contact": FLAT, "fixed": {"contact_compliance": 1.0}, "shape": "fixed"},
        "read_parameters": {"path": REPOSITORY / "cli" / "example.toml"},
        "Contact": {**FLAT, **LAYER},
        "Contact.elliptic": {**ELLIPSE, **LAYER},
        "Contact.from_bytes": {"data": bytes(contact)},
        "Contact.tractions": {"load": 100.0, "x": [0.0]},
        "Contact.slip": {"force": 100.0, "x": [0.0]},
        "Contact.monotonic_displacement": {"force": [100.0]},
        "Contact.monotonic_force": {"displacement": [1e-7]},
        "Contact.monotonic_sensitivity": {"displacement": [1e-7]},
        "Contact.update": {"state": state, "displacement": [1e-7], "out": out},
        "Contact.hysteresis_loop": {"amplitude": 1e-7, "n": 10},
        "Contact.dissipated_energy": {"force_amplitude": [100.0]},
        "Contact.complex_stiffness": {"amplitude": [1e-7]},
        "Contact.harmonic_force": {"workspace": workspace, "displacement": [0, 1e-7, 0], "jacobian": True},
        "Contact.harmonic_sensitivity": {"workspace": workspace, "displacement": [0, 1e-7, 0]},
        "Contact.jenkins_equivalent": {"amplitude": 1e-7},
        "Contact.iwan_equivalent": {"n": 4},
        "State": {"reversals": 8},
        "State.from_bytes": {"data": bytes(state)},
        "State.copy": {},
        "Workspace": {"harmonics": 1, "samples": 8, "rule": 1},
        "ContactArray": {"contacts": [contact]},
        "ContactArray.states": {"n": 2, "reversals": 8},
        "ContactArray.complex_stiffness": {"amplitude": [1e-7, 1e-7], **MANY},
        "ContactArray.update": {"states": contacts.states(), "displacement": [0, 0], **MANY, "out": contacts.states()},
        "ContactArray.harmonic_force": {"workspace": workspace, "displacement": np.zeros((2, 3)), "jacobian": True, **MANY},
        "Element": {**FLAT, **LAYER, **DIRECTIONS},
        "Element.elliptic": {**ELLIPSE, **LAYER, **DIRECTIONS},
        "Element.from_bytes": {"data": bytes(element)},
        "Element.normal_force_at": {"approach": [1e-6]},
        "Element.approach_at": {"normal_force": [100.0]},
        "Element.displacement_at": {"force": [10.0], "normal_force": [100.0], "direction": 0},
        "Element.update": {"state": element_state, "displacement": [[0, 1e-6]], "out": element_out},
        "Element.tractions": {"state": element_state, "x": [0.0]},
        "Element.harmonic_force": {"workspace": element_workspace, "displacement": np.zeros((2, 3)), "jacobian": False},
        "ElementState": {"directions": 1, "pieces": 8},
        "ElementState.from_bytes": {"data": bytes(element_state), "directions": 1},
        "ElementState.copy": {},
        "ElementWorkspace": {"directions": 1, "harmonics": 1, "samples": 8, "rule": 0, "periods": 3},
        "ElementArray": {"elements": [element]},
        "ElementArray.states": {"n": 2, "pieces": 8},
        "ElementArray.update": {
            "states": elements.states(),
            "displacement": np.zeros((2, 2)),
            **MANY,
            "out": elements.states(),
        },
        "ElementArray.harmonic_force": {
            "workspace": element_workspace,
            "displacement": np.zeros((2, 2, 3)),
            "jacobian": True,
            **MANY,
        },
    }


OBJECTS = {
    "Contact": contact,
    "Element": element,
    "ContactArray": contacts,
    "ElementArray": elements,
    "State": state,
    "ElementState": element_state,
}


def public():
    """Every public function, and every public method of the classes; results, codes and errors have none of their own."""
    for name in microslip.__all__:
        value = getattr(microslip, name)
        if not callable(value) or (isinstance(value, type) and issubclass(value, (tuple, enum.Enum, Exception))):
            continue
        yield name, value
        for method in dir(value) if isinstance(value, type) else ():
            if not method.startswith("_") and callable(getattr(value, method)):
                yield f"{name}.{method}", getattr(OBJECTS.get(name, value), method)


PUBLIC = dict(public())
frozen = np.zeros(2)
frozen.flags.writeable = False
# What no argument may be, and what some may be.
WRONG = [object(), 1j, "bogus", np.ma.array([1e-7, 2e-7], mask=[0, 1]), np.ma.array(1e-7), [1e-7, np.ma.array(1.0)], np.array("x")]
STRANGE = [None, True, -1, 0, 2, 2**40, 2**70, 1.5, np.nan, np.inf, 1e308, b"", "", "1", (), {}, [], [[1.0]], [[1], [2, 3]], [None]]
STRANGE += [np.zeros((2, 2)), np.zeros((0, 3)), np.zeros(1, np.float32), np.float32(1), np.int8(1), np.array(1), frozen]
STRANGE += [np.longdouble("1e4000"), contact, element, contacts, elements, microslip.State(), microslip.ElementState()]
STRANGE += [workspace, element_workspace, [1e300] * 2, [-1, 5], [0.5, 0.5]]


def test_every_public_function_is_walked():
    assert set(PUBLIC) == set(valid())
    for name, arguments in valid().items():
        assert list(arguments) == list(inspect.signature(PUBLIC[name]).parameters)
        PUBLIC[name](**arguments)


class Recorder:
    def __init__(self, lib):
        self.lib, self.called = lib, set()

    def __getattr__(self, name):
        self.called.add(name)
        return getattr(self.lib, name)


def test_every_function_of_the_header_is_called(monkeypatch):
    declared = set(re.findall(r"^\w.*?\b(mslip_\w+)\(", HEADER, flags=re.MULTILINE))
    recorder = Recorder(_core.lib)
    for module in (_core, _contact, _element, _law, _memory):
        monkeypatch.setattr(module, "lib", recorder)
    for name, arguments in valid().items():
        PUBLIC[name](**arguments)
    # The variants of arguments; the rest are constants of the package.
    assert contact.update(state, 1e-7).state.force_error == 0
    assert element.update(element_state, [0, 1e-6]).state.force_error == 0
    contact.tractions(state, 0.0)
    assert recorder.called == declared - {"mslip_version", "mslip_abi_version"}


@pytest.mark.filterwarnings("ignore::microslip.PlausibilityWarning")
@pytest.mark.parametrize("name", PUBLIC)
def test_arguments_are_accepted_or_rejected_by_name(name):
    kept = [bytes(x) for x in (contact, element, state, element_state)]
    for argument in valid()[name]:
        for wrong in WRONG + STRANGE:
            never = any(wrong is value for value in WRONG)
            error = None
            try:
                PUBLIC[name](**valid()[name] | {argument: wrong})
            except (TypeError, ValueError, OSError) as reason:
                error = reason
            # Two shapes that do not agree are rejected by the name of one; several displacements may need an index.
            names = {argument} if never else {argument, "index"} | ({"states"} & valid()[name].keys())
            by_name = any(re.search(rf"\b{one}\b", str(error)) for one in names)
            by_library = isinstance(error, (microslip.Error, microslip.FitError))
            no_file = isinstance(error, OSError)
            assert by_name or no_file or (not never and (error is None or by_library)), (argument, wrong, error)
    assert kept == [bytes(x) for x in (contact, element, state, element_state)]


def test_messages_of_arguments():
    for call, message in [
        (
            lambda: microslip.Contact(**FLAT | {"displacement_reference": -1}),
            r"must be 'centre_point' \(0\) or 'rigid_strip' \(1\), not -1",
        ),
        (lambda: microslip.Element(**FLAT, normal_input=microslip.Parameter.NORMAL_FORCE), r"\(16\) or 'normal_force' \(17\), not"),
        (lambda: microslip.Contact(**{name: FLAT[name] for name in FLAT if "ref" not in name}), "'displacement_reference'"),
        (
            lambda: contact.harmonic_force(workspace, np.zeros(7)),
            r"displacement must be an array of shape \(3,\), not an array of .*7",
        ),
        (lambda: contact.update(microslip.State(4), 0, out=microslip.State(5)), "out must be a contiguous, writable array"),
        (lambda: contacts.complex_stiffness(np.zeros(3)), "3 items need an index: there are 2 contacts"),
        (lambda: microslip.ContactArray([contact, element]), r"contacts\[1\] must be of type Contact, not Element"),
    ]:
        with pytest.raises((TypeError, ValueError), match=message):
            call()


def test_constants_are_given_by_number_or_word():
    for wanted, word in [(microslip.CENTRE_POINT, "centre_point"), (microslip.RIGID_STRIP, "rigid_strip")]:
        for make in (microslip.Contact, microslip.Element):
            assert make(**FLAT | {"displacement_reference": wanted}) == make(**FLAT | {"displacement_reference": word})
    assert microslip.Workspace(1, 8, "event_driven").rule == microslip.EVENT_DRIVEN
    assert microslip.Element(**FLAT, normal_input="normal_force").normal_input == microslip.INPUT_NORMAL_FORCE


def test_numbers_of_numpy_are_numbers():
    converted = {name: np.float64(value) for name, value in FLAT.items() if isinstance(value, float)}
    assert microslip.Contact(**FLAT | converted | {"young_modulus": np.array([2e11, 1.1e11])}) == contact
    assert microslip.Workspace(np.int64(1), np.array(8)) == workspace
    assert contact.hysteresis_loop(np.array(1e-7), np.uint8(3)).force.shape == (3,)


@pytest.mark.parametrize("one", [contact, element])
def test_read_only_states_are_not_written(one, tmp_path):
    kind, to = (microslip.State, 1e-7) if one is contact else (microslip.ElementState, [1e-7, 1e-6])
    read_only = kind()
    read_only.array.flags.writeable = False
    kept = bytes(read_only)
    with pytest.raises(ValueError, match="read-only"):
        one.update(kind(), to, out=read_only)
    assert bytes(read_only) == kept
    assert one.update(read_only, to).state != read_only
    with pytest.raises(AttributeError):
        read_only.array = np.zeros(3)
    np.save(tmp_path / "restart.npy", (contacts if one is contact else elements).states())
    rows = np.load(tmp_path / "restart.npy", mmap_mode="r")
    with pytest.raises(ValueError, match="read-only"):
        (contacts if one is contact else elements).update(rows, [to, to], out=rows)


def test_outputs_that_overlap_inputs_are_rejected():
    memory = np.zeros((3, contacts.states().shape[1]))
    memory[:] = contacts.states(1)
    with pytest.raises(ValueError, match="out must not overlap states"):
        contacts.update(memory[:2], [SLIP, SLIP], out=memory[1:])
    with pytest.raises(ValueError, match="out must not overlap displacement"):
        contacts.update(contacts.states(), memory[1, :2], out=memory[1:])
    assert (memory == contacts.states(1)).all()


def test_states_are_safe_whatever_is_done_to_their_arrays():
    for name, value in [("dtype", ">f8"), ("dtype", "f4"), ("shape", (-1, 1))]:
        one = microslip.State()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # NumPy may advise another way
            setattr(one.array, name, value)
        for call in (lambda: contact.update(one, 1e-7), lambda: contact.update(microslip.State(), 1e-7, out=one)):  # noqa: B023
            with contextlib.suppress(ValueError):
                call()


def test_objects_can_only_be_read():
    for one in (contact, element, contacts, elements, workspace, element_workspace, state):
        for name in ("harmonics", "samples", "slip_force", "normal_force", "edge_radius", "any"):
            with pytest.raises(AttributeError, match=f"{name} of a {type(one).__name__} can only be read"):
                setattr(one, name, 1)


def test_parameters_are_shown_and_kept():
    sphere = microslip.Element.elliptic(**ELLIPSE, directions=2, normal_input="normal_force")
    copies = element, copy.copy(element), pickle.loads(pickle.dumps(element))
    many = *microslip.ContactArray([contact]), *microslip.ElementArray(copies)
    for one in (*many, contact, sphere):
        assert eval(repr(one), {name: getattr(microslip, name) for name in ("Contact", "Element")}) == one
        assert all(getattr(one, name) == value for name, value in one.parameters.items())
    assert (contact.young_modulus, contact.displacement_reference) == (FLAT["young_modulus"], microslip.CENTRE_POINT)
    with pytest.raises(AttributeError, match="Contact has no attribute 'radius'"):
        _ = contact.radius
    from_bytes = microslip.Contact.from_bytes(bytes(contact))
    assert from_bytes == contact
    assert not from_bytes.parameters
    assert "bytes" in repr(from_bytes)


def test_warnings_of_implausible_parameters():
    millimetres = {name: 1e3 * FLAT[name] for name in ("flat_half_width", "edge_radius", "length")}
    for changes, texts in [
        ({"friction_coefficient": 45}, ["friction_coefficient is implausible"]),
        ({"length": 20.0, "friction_coefficient": 45}, ["length is implausible", "friction_coefficient is implausible"]),
        ({**millimetres, "young_modulus": (2e5, 1.1e5)}, []),
    ]:
        for make in (microslip.Contact, microslip.Element):
            with warnings.catch_warnings(record=True) as found:
                warnings.simplefilter("always")
                make(**FLAT | changes)
            assert len(found) == len(texts)
            assert all(str(one.message).startswith(text) for one, text in zip(found, texts))
            assert all((one.category, one.filename) == (microslip.PlausibilityWarning, __file__) for one in found)


def test_values_are_equal_and_shown():
    other = microslip.Contact(**FLAT | {"length": 0.03})
    for one, equal, different in [
        (contact, microslip.Contact(**FLAT), other),
        (element, microslip.Element(**FLAT), microslip.Element(**FLAT, directions=2)),
        (contacts, microslip.ContactArray([contact] * 2), microslip.ContactArray([contact, other])),
        (elements, microslip.ElementArray([element] * 2), microslip.ElementArray([])),
        (workspace, microslip.Workspace(1, 8), microslip.Workspace(1, 9)),
        (state, microslip.State(), contact.update(state, 1e-7).state),
        (element_state, microslip.ElementState(), microslip.ElementState(2)),
    ]:
        assert one == equal
        assert one != different
        assert one != 1
        assert type(one).__name__ in repr(one)
        assert "object at" not in repr(one)
        if one not in (state, element_state):
            assert len({one, equal, different}) == 2
    assert repr(workspace) == "Workspace(harmonics=1, samples=8, rule='uniform_sampling')"
    assert repr(contacts) == "<ContactArray of 2 contacts>"


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork")
@pytest.mark.filterwarnings("ignore:This process")
def test_fork_while_a_thread_computes():
    # A call of about a millisecond, so that the fork meets it.
    long = microslip.Workspace(2, 20_000)
    at = SLIP * np.array([0.1, 1.3, 0.2, -0.3, 0.4])
    expected = contact.harmonic_force(long, at).force
    stop = threading.Event()

    def run():
        while not stop.is_set():
            contact.harmonic_force(long, at)

    thread = threading.Thread(target=run)
    thread.start()
    children = []
    for _ in range(10):
        child = os.fork()
        if child == 0:
            import signal

            signal.alarm(20)  # a child that waits for ever is ended, with another status than 0
            os._exit(int(not np.array_equal(contact.harmonic_force(long, at).force, expected)))
        children.append(child)
    stop.set()
    thread.join()
    assert [os.waitpid(child, 0)[1] for child in children] == [0] * 10
