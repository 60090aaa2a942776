"""Arguments are converted by one function for each kind, which rejects wrong ones by name; objects, states and copies of them.

What the library rejects is tested in Rust.
"""

from __future__ import annotations

import contextlib
import copy
import os
import pickle
import threading
import warnings

import microslip
import numpy as np
import pytest
from tables import ELLIPSE, FLAT

contact = microslip.Contact(**FLAT)
element = microslip.Element(**FLAT)
contacts = microslip.ContactArray([contact, contact])
elements = microslip.ElementArray([element, element])
workspace = microslip.Workspace(1, 8)
element_workspace = microslip.ElementWorkspace(1, 1, 8)
state = microslip.State()
element_state = microslip.ElementState()
SLIP = contact.slip_displacement
frozen = np.zeros(2)
frozen.flags.writeable = False

# A call for each kind of conversion: the name of the argument, and values that are not of the kind.
OBJECTS = [object(), 1j, "x", None]
MASKED = [np.ma.array([1e-7, 2e-7], mask=[0, 1]), np.ma.array(1e-7), [1e-7, np.ma.array(1.0)]]
NO_NUMBERS = [object(), 1j, "x", np.array("x"), b"", "1", {}, [[1], [2, 3]], [None], contact, *MASKED]
KINDS = [
    (lambda x: contact.harmonic_force(x, np.zeros(3)), "workspace", [*OBJECTS, element_workspace]),
    (lambda x: contact.update(x, 1e-7), "state", [*OBJECTS, element_state, frozen]),
    (lambda x: microslip.ContactArray(x), "contacts", [*OBJECTS, [element], [1]]),
    (lambda x: contact.harmonic_force(workspace, np.zeros(3), x), "jacobian", [*OBJECTS, 1, 0.0]),
    (lambda x: microslip.Workspace(x, 8), "harmonics", [*OBJECTS, -1, 2**40, 2**70, 1.5, True, np.nan, [], MASKED[0]]),
    (lambda x: microslip.Workspace(1, 8, x), "rule", [*OBJECTS, 2, -1, 1.5, True, ""]),
    (lambda x: contact.monotonic_force(x), "displacement", NO_NUMBERS),
    (lambda x: contact.complex_stiffness(x), "amplitude", NO_NUMBERS),
    (lambda x: element.update(element_state, x), "displacement", [*NO_NUMBERS, [], [1.0], np.zeros((0, 3))]),
    (lambda x: contact.jenkins_equivalent(x), "amplitude", [*NO_NUMBERS, [], [[1.0]], frozen]),
    (lambda x: microslip.Contact(**FLAT | {"young_modulus": x}), "young_modulus", [*NO_NUMBERS, [], [1.0] * 3]),
    (lambda x: contacts.complex_stiffness([0, 0], index=x), "index", [*NO_NUMBERS, [0.5, 0.5], [0], [[0, 0]]]),
    (lambda x: contacts.complex_stiffness([0, 0], active=x), "active", [*NO_NUMBERS, [0.5, 0.5], [1]]),
    (lambda x: contacts.update(contacts.states(), [0, 0], out=x), "out", [*OBJECTS[:3], frozen, np.zeros((2, 2), np.float32)]),
    (lambda x: microslip.State.from_bytes(x), "data", [*OBJECTS, 1, [1]]),
]


@pytest.mark.parametrize(("call", "name", "wrong"), KINDS, ids=[name for _, name, _ in KINDS])
def test_other_kinds_are_rejected_by_name(call, name, wrong):
    for value in wrong:
        with pytest.raises((TypeError, ValueError), match=rf"\b{name}\b") as error:
            call(value)
        assert not isinstance(error.value, microslip.Error), value


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


def test_parts_of_a_face():
    whole = {**FLAT, "displacement_reference": "rigid_strip", "tangential_compliance": 1e-9, "stiffening_load": 50.0}
    area = np.array([[1e-6, 2e-6, 0.0], [3e-6, 2e-6, 1e-6], [1e-6, 0.0, 0.0]])
    even = np.full_like(area, 800.0 / area.sum())
    parts, weight = microslip.face_parts(whole, area, even)
    np.testing.assert_allclose(weight, area / area.sum(axis=1, keepdims=True), rtol=1e-15)
    stiffness = sum(microslip.Contact(**part).initial_stiffness for part in parts)
    np.testing.assert_allclose(stiffness, microslip.Contact(**whole).initial_stiffness, rtol=1e-13)
    parts, weight = microslip.face_parts(whole, area[:, ::-1], even * [[1], [0], [3]])
    assert [part["normal_force"] for part in parts] == [240.0, 0.0, 240.0]
    np.testing.assert_allclose(weight.sum(axis=1), 1.0, rtol=1e-15)
    for change, message in [
        ((whole, area, -even), "BAD_PRESSURE"),
        ((whole, area, even[0]), r"pressure must be an array of shape \(3, 3\), not an array"),
        (({**whole, "radius": 1.0}, area, even), "radius"),
        (({"length": 1.0}, area, even), "missing"),
    ]:
        with pytest.raises((TypeError, ValueError), match=message):
            microslip.face_parts(*change)


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
