"""The C interface through Python: all functions, errors as exceptions, arrays without copies, matrices not transposed."""

from __future__ import annotations

import copy
import importlib
import pickle
import re
import threading
from types import SimpleNamespace

import microslip
import numpy as np
import pytest
from microslip import _core
from numpy.testing import assert_allclose
from tables import ELLIPSE, FLAT, HEADER, differences

contact = microslip.Contact(**FLAT)
elliptic = microslip.Contact.elliptic(**ELLIPSE)
element = microslip.Element(**FLAT)
both = microslip.Element(**FLAT, directions=2)
contacts = microslip.ContactArray([contact, elliptic])
elements = microslip.ElementArray([element, microslip.Element.elliptic(**ELLIPSE)])
workspace = microslip.Workspace(2, 64)
element_workspace = microslip.ElementWorkspace(1, 2, 64)
SLIP = contact.slip_displacement
HARMONICS = SLIP * np.array([0.1, 1.3, 0.2, -0.3, 0.4])
ELEMENT_HARMONICS = np.array([HARMONICS, element.approach * np.array([0.7, 0.2, 0.1, -0.05, 0.1])])


def pressed(directions=1):
    one = both if directions == 2 else element
    return one.update(microslip.ElementState(directions), [SLIP] * directions + [one.approach]).state


def reloaded(value):
    return pickle.loads(pickle.dumps(value))


def test_status_codes_and_constants_are_those_of_the_header():
    defined = {name: int(value) for name, value in re.findall(r"#define MSLIP_(\w+) (\d+)", HEADER)}
    version = ".".join(str(defined.pop(f"VERSION_{part}")) for part in ("MAJOR", "MINOR", "PATCH"))
    assert microslip.__version__ == version
    assert defined.pop("OK") == 0
    references, rules = ["CENTRE_POINT", "RIGID_STRIP"], ["UNIFORM_SAMPLING", "EVENT_DRIVEN"]
    for name in ["ABI_VERSION", *references, *rules, "INPUT_APPROACH", "INPUT_NORMAL_FORCE"]:
        assert getattr(microslip, name) == defined.pop(name)
    assert len(microslip.Parameter) == defined.pop("PARAMETER_COUNT")
    for parameter in microslip.Parameter:
        assert parameter.value == defined.pop(f"BY_{parameter.name}")
    assert {status.name: status.value for status in microslip.Status} == defined
    # The comment above each definition of a code is its message.
    for text, name in re.findall(r"// (.*)\n#define MSLIP_(\w+) \d+", HEADER):
        if name in microslip.Status.__members__:
            assert microslip.status_text(microslip.Status[name]) == text


def test_library_of_another_interface(monkeypatch):
    with monkeypatch.context() as patch:
        other = SimpleNamespace(mslip_version=microslip.lib.mslip_version, mslip_abi_version=lambda: 0, MSLIP_ABI_VERSION=6)
        patch.setattr("microslip._core.lib", other)
        with pytest.raises(ImportError, match="different interfaces"):
            importlib.reload(microslip)
    importlib.reload(microslip)


def test_errors():
    with pytest.raises(microslip.Error, match=r"^edge_radius must be finite and > 0") as caught:
        microslip.Contact(**{**FLAT, "edge_radius": -1})
    assert caught.value.status is microslip.Status.BAD_EDGE_RADIUS
    assert reloaded(caught.value).status == caught.value.status
    with pytest.raises(microslip.Error, match="not available"):
        elliptic.slip(1.0, [0.0])
    for index in (2, 2**32):
        with pytest.raises(microslip.Error, match="BAD_INDEX"):
            contacts.complex_stiffness([1e-7], index=[index])
    with pytest.raises(microslip.Error, match="BAD_DIRECTIONS"):
        microslip.ElementArray([element, both])
    with pytest.raises(microslip.Error, match="BAD_DIRECTIONS"):
        both.harmonic_force(element_workspace, ELEMENT_HARMONICS)
    state = microslip.State()
    before = bytes(state)
    with pytest.raises(microslip.Error):
        contact.update(state, [1e-7, np.inf], out=state)
    assert bytes(state) == before


def test_layers_are_in_series():
    layer = {"tangential_compliance": 2 / contact.initial_stiffness, "normal_compliance": 1 / element.normal_stiffness}
    soft, pressed_softly = microslip.Contact(**FLAT, **layer), microslip.Element(**FLAT, **layer)
    assert_allclose(soft.initial_stiffness, contact.initial_stiffness / 3, rtol=1e-14)
    assert_allclose(pressed_softly.normal_stiffness, element.normal_stiffness / 2, rtol=1e-14)
    force = np.array([[0.3], [-0.9]]) * contact.slip_force
    found = pressed_softly.displacement_at(force, FLAT["normal_force"])
    assert_allclose(found.displacement, soft.monotonic_displacement(force).displacement, rtol=1e-12)
    assert found.compliance.shape == (2, 1)
    assert np.isscalar(element.displacement_at(0, 1.0).displacement)
    with pytest.raises(microslip.Error, match="BAD_DIRECTIONS"):
        element.displacement_at(1.0, 100.0, direction=1)
    with pytest.raises(microslip.Error, match="tangential_compliance of a layer"):
        microslip.Contact(**FLAT, tangential_compliance=-1)


def test_arrays_are_used_as_they_are_or_converted():
    exact = np.linspace(-2, 2, 7) * SLIP
    assert _core.doubles(exact, "x") is exact
    frozen = exact.copy()
    frozen.flags.writeable = False
    assert _core.doubles(frozen, "x") is frozen
    assert contact.monotonic_force(frozen).force.shape == (7,)
    memory = _core.ffi.cast("intptr_t", _core.pointer(exact))
    assert int(memory) == exact.ctypes.data
    expected = contact.monotonic_force(exact).force
    strided = np.zeros((7, 3))[:, 1]
    strided[:] = exact
    shifted = np.zeros(57, dtype=np.uint8)[1:].view(np.float64)
    shifted[:] = exact
    for other in [list(exact), exact.astype(">f8"), strided, shifted, exact.astype(np.longdouble)]:
        assert (contact.monotonic_force(other).force == expected).all()
    square = np.asfortranarray(exact[:6].reshape(2, 3))
    assert (contact.monotonic_force(square).force == expected[:6].reshape(2, 3)).all()
    assert_allclose(contact.monotonic_force(exact.astype(np.float32)).force, expected, rtol=1e-6)
    assert contact.monotonic_force(np.array([0, 1])).force[1] == contact.slip_force
    scalar = contact.monotonic_force(SLIP / 2).force
    assert isinstance(scalar, float)
    assert contact.monotonic_force(np.zeros((0, 2))).force.shape == (0, 2)


@pytest.mark.parametrize("directions", [0, 1, 2])
def test_jacobians_are_not_transposed(directions):
    """Of a contact under a constant load, and of elements with one direction and with two."""
    one = [contact, element, both][directions]
    u = [HARMONICS, ELEMENT_HARMONICS, np.insert(ELEMENT_HARMONICS, 1, HARMONICS[::-1], axis=0)][directions]
    space = microslip.ElementWorkspace(directions, 2, 64) if directions else workspace
    found = one.harmonic_force(space, u)
    assert found.force.shape == u.shape
    # Differences of second order; steps within a branch.
    steps = 1e-7 * (np.array([[SLIP]] * directions + [[element.approach]]) if directions else SLIP)
    expected = differences(lambda u: one.harmonic_force(space, u, jacobian=False).force, u, steps).reshape(u.size, u.size)
    scale = abs(expected).max()
    if directions:
        # Nothing tangential changes the normal force; the normal displacement changes the tangential force.
        assert (found.jacobian[5 * directions :, : 5 * directions] == 0).all()
        assert abs(found.jacobian[: 5 * directions, 5 * directions :]).max() > 0.01 * scale
    else:
        assert abs(expected - expected.T).max() > 0.1 * scale
    assert_allclose(found.jacobian, expected, rtol=0, atol=(1e-5 if directions else 1e-6) * scale)
    array = (microslip.ElementArray if directions else microslip.ContactArray)([one])
    batch = array.harmonic_force(space, [u, 0.5 * u], index=[0, 0])
    for i, single in enumerate([found, one.harmonic_force(space, 0.5 * u)]):
        assert (batch.force[i] == single.force).all()
        assert (batch.jacobian[i] == single.jacobian).all()
        assert batch.dissipated[i] == single.dissipated


def test_drift_and_periods():
    # A mean shear beside a vibration across it.
    u = np.array([[0.8 * SLIP, 0, 0], [0, 0, 0.2 * SLIP], [0.7 * element.approach, 0, 0]])
    space = microslip.ElementWorkspace(2, 1, 32, periods=3)
    drift = both.harmonic_force(space, u).drift
    assert space.periods == 3
    assert 0 < drift < 1
    assert (microslip.ElementArray([both]).harmonic_force(space, [u, u], index=[0, 0]).drift == drift).all()


@pytest.mark.parametrize("directions", [1, 2])
def test_tangents_are_not_transposed(directions):
    one = element if directions == 1 else both
    state = pressed(directions)
    to = np.array([*[1.4 * SLIP, 0.7 * SLIP][:directions], 0.9 * element.approach])
    found = one.update(state, to)
    expected = differences(lambda u: one.update(state, u).force, to, 1e-6 * to)
    assert abs(found.tangent[0, -1]) > 0
    assert found.tangent[-1, 0] == 0
    assert_allclose(found.tangent, expected, rtol=0, atol=1e-5 * abs(expected).max())
    path = one.update(state, [to, 0.5 * to])
    assert (path.tangent[0] == found.tangent).all()
    array = microslip.ElementArray([one, one])
    force, tangent, dissipated, new = array.update(np.array([state.array, state.array]), [to, 0.5 * to])
    assert (force[0] == found.force).all()
    assert (tangent[0] == found.tangent).all()
    assert dissipated[0] == found.dissipated
    assert (new[0] == found.state.array).all()


def test_sensitivities_are_in_their_places():
    # All forces in proportion: N dT/dN + E* dT/dE* = T. Beyond gross slip T = mu N.
    displacement = np.array([[0.3, 0.9], [-0.7, 1.5]]) * SLIP
    found = contact.monotonic_sensitivity(displacement)
    assert found.sensitivity.shape == (2, 2, 7)
    by = {parameter.name: found.sensitivity[..., parameter] for parameter in microslip.Parameter}
    in_proportion = FLAT["normal_force"] * by["NORMAL_FORCE"] + contact.composite_modulus * by["COMPOSITE_MODULUS"]
    assert_allclose(in_proportion, found.force, rtol=1e-11)
    assert by["FRICTION_COEFFICIENT"][1, 1] == pytest.approx(FLAT["normal_force"])
    of_harmonics = contact.harmonic_sensitivity(workspace, HARMONICS)
    assert of_harmonics.sensitivity.shape == (5, 7)
    assert (of_harmonics.force == contact.harmonic_force(workspace, HARMONICS).force).all()


def test_batches_name_the_item_at_fault():
    displacement = [[SLIP, 1e-6], [SLIP, np.nan]]
    with pytest.raises(microslip.Error, match=r"^item 1: a displacement must be finite") as caught:
        elements.update(elements.states(), displacement)
    assert caught.value.item == reloaded(caught.value).item == 1
    with pytest.raises(microslip.Error, match=r"^item 2: .*BAD_INDEX") as caught:
        contacts.complex_stiffness(np.zeros(3), index=[0, 1, 2])
    with pytest.raises(microslip.Error, match=r"^item 0: .*BAD_DIRECTIONS") as caught:
        elements.harmonic_force(microslip.ElementWorkspace(2, 1, 8), np.zeros((2, 3, 3)))
    with pytest.raises(microslip.Error, match=r"^state_length must") as caught:
        contacts.update(contacts.states()[:, :0], [0, 0])
    assert caught.value.item is None


def test_plain_data_is_pickled_and_checked():
    state = contact.update(microslip.State(), [SLIP / 2, -SLIP / 4]).state
    for value in [contact, elliptic, element, both, state, pressed(), pressed(2)]:
        for other in [reloaded(value), copy.deepcopy(value)]:
            assert type(other) is type(value)
            assert other is not value
            assert bytes(other) == bytes(value)
    assert reloaded(pressed(2)).directions == 2
    assert [bytes(c) for c in reloaded(contacts)] == [bytes(c) for c in contacts]
    assert [bytes(c) for c in reloaded(elements)] == [bytes(c) for c in elements]
    expected = contact.harmonic_force(workspace, HARMONICS).dissipated
    assert contact.harmonic_force(reloaded(workspace), HARMONICS).dissipated == expected
    assert reloaded(element_workspace) == element_workspace
    # One wrong byte in the stored copy.
    for value, status in [
        (contact, microslip.Status.BAD_CONTACT),
        (element, microslip.Status.BAD_ELEMENT),
        (state, microslip.Status.BAD_STATE),
        (pressed(), microslip.Status.BAD_STATE),
    ]:
        pickled = pickle.dumps(value)
        data = bytes(value)
        broken = data[:3] + bytes([data[3] ^ 0x40]) + data[4:]
        with pytest.raises(microslip.Error) as caught:
            pickle.loads(pickled.replace(data, broken))
        assert caught.value.status == status
    with pytest.raises(microslip.Error):
        microslip.State.from_bytes(b"")


def test_threads_share_a_workspace():
    # Calls of about a millisecond, so that threads meet in them.
    long = microslip.Workspace(2, 20_000)
    scales = [1, 0.5, 0.1] * 10
    expected = [contact.harmonic_force(long, HARMONICS * scale).force for scale in scales]
    results = [[] for _ in range(4)]

    def run(mine):
        mine.extend(contact.harmonic_force(long, HARMONICS * scale).force for scale in scales)

    threads = [threading.Thread(target=run, args=(mine,)) for mine in results]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(mine, expected) for mine in results)
