"""Contacts and elements as functions of JAX, with the exact derivatives of the library.

    from jax_microslip import harmonic_force, history
    force = harmonic_force(parameters, microslip.Workspace(5, 128))
    force(displacement, {"friction_coefficient": 0.4})  # jit, vmap, jvp, grad, jacfwd, jacrev
    history(microslip.Contact(...))(displacement)

Each function is force(displacement, changed={}); the force [N] has the shape of the displacement. Its law is a
`microslip.Contact` or `microslip.Element`; or the arguments of a contact, some of which may be `changed`: a dictionary of numbers
with names of `NAMES`, by which the force has derivatives, too.

The library runs on the host. Arrays are float64, so JAX must be told `jax.config.update("jax_enable_x64", True)`. Items of `vmap`
are one call of the host. Derivatives are of first order: a second one is refused by JAX.
"""

import jax
import jax.numpy as jnp
import microslip
import numpy as np
from jax.custom_derivatives import SymbolicZero

# Names of parameters of a contact in the library's order of derivatives.
NAMES = [parameter.name.lower() for parameter in microslip.Parameter]


def contact(arguments, changed):
    """The `microslip.Contact` of these arguments, some of them `changed`, which have the names of `NAMES`."""
    # A layer remains the same under another normal force.
    arguments, changed = {"reference_load": arguments["normal_force"]} | dict(arguments), dict(changed)
    if "composite_modulus" in changed:
        factor = changed.pop("composite_modulus") / microslip.Contact(**arguments).composite_modulus
        arguments["young_modulus"] = np.multiply(arguments["young_modulus"], factor).tolist()
    if "layer_compliance" in changed:
        arguments["tangential_compliance"] = changed.pop("layer_compliance")
    return microslip.Contact(**arguments | changed)


def harmonic_force(law, workspace):
    """Coefficients of the force in steady state: `Contact.harmonic_force`, `Element.harmonic_force`."""
    many = microslip.ElementArray if isinstance(law, microslip.Element) else microslip.ContactArray

    def on_host(laws, index, u, by_displacement, by_parameters):
        found = many(laws).harmonic_force(workspace, u, jacobian=by_displacement, index=index)
        each = [laws[i].harmonic_sensitivity(workspace, v).sensitivity for i, v in zip(index, u)] if by_parameters else None
        return found.force, found.jacobian, each

    return _differentiable(law, on_host)


def monotonic_force(law):
    """The force of the monotonic curve of a contact at a displacement: `Contact.monotonic_force`."""

    def on_host(laws, index, u, by_displacement, by_parameters):
        force, stiffness, sensitivity = np.empty(len(u)), np.empty(len(u)), np.empty((len(u), len(NAMES)))
        for i, one in enumerate(laws):
            force[index == i], stiffness[index == i], _ = one.monotonic_force(u[index == i])
            if by_parameters:
                sensitivity[index == i] = one.monotonic_sensitivity(u[index == i]).sensitivity
        return force, stiffness, sensitivity

    return _differentiable(law, on_host)


def history(law):
    """Forces (n) or (n, 2) at successive displacements from the initial state, of a contact or of an element of one direction by
    its approach: `Contact.update`, `Element.update`.
    """
    if isinstance(law, microslip.Element):
        if law.directions != 1 or law.normal_input != microslip.INPUT_APPROACH:
            raise ValueError("histories of elements have exact derivatives with one direction and INPUT_APPROACH only")
        return _differentiable(law, _element_history)
    monotonic = monotonic_force(law)

    def force(displacement, changed=None):
        # Masing's rule: on a branch F = F_r + 2 S((u - u_r)/2), on the monotonic curve S(u); n stands for no reversal.
        displacement = jnp.asarray(displacement, float)
        n = len(displacement)
        reversal = jax.pure_callback(
            lambda u: np.apply_along_axis(_reversals, -1, np.asarray(u)),
            jax.ShapeDtypeStruct((n,), jnp.int32),
            jax.lax.stop_gradient(displacement),
            vmap_method="broadcast_all",
        )
        factor = jnp.where(reversal == n, 1, 2)
        distance = displacement - jnp.append(displacement, 0)[reversal]
        total = factor * jax.vmap(monotonic, (0, None))(distance / factor, changed or {})
        # The sum of each force with that of its reversal, with that of the reversal before it, ..., by doubling.
        total, reversal = jnp.append(total, 0), jnp.append(reversal, n)
        for _ in range(n.bit_length()):
            total, reversal = total + total[reversal], reversal[reversal]
        return total[:n]

    return force


def _reversals(u):
    """The place of the reversal from which the branch of each displacement starts; n on the monotonic curve. A branch is left where
    its loop closes: at the reversal before its own, or, from the first one, at that with the other sign.
    """
    found, open_ones, rising, last = [], [], 0, 0.0
    for i, at in enumerate(u):
        direction = np.sign(at - last)
        if direction * rising < 0:
            open_ones.append(i - 1)
        rising = direction or rising
        while open_ones:
            end = u[open_ones[-2]] if len(open_ones) > 1 else -u[open_ones[-1]]
            if (at - end) * rising < 0:
                break
            del open_ones[-2:]
        found.append(open_ones[-1] if open_ones else len(u))
        last = at
    return np.array(found, dtype=np.int32)


def _element_history(laws, index, u, by_displacement, by_parameters):
    """The derivatives are those of the harmonic force of a period that has the displacements as samples and then opens the contact,
    which forgets: at the first displacement with the other sign, so that it closes at zero displacement, as the initial state.
    """
    items, n, _ = u.shape
    if items == 0:
        return u, np.zeros((*u.shape, n, 2)), None
    force = np.array([laws[0].update(microslip.ElementState(1, n + 2), path).force for path in u])
    if not by_displacement:
        return force, None, None
    extra = 3 - n % 2
    size = n + extra
    phase = 2 * np.pi / size * np.outer(np.arange(size), np.arange(1, size // 2 + 1))
    samples_of = np.column_stack([np.ones(size), np.stack([np.cos(phase), np.sin(phase)], -1).reshape(size, -1)])
    coefficients_of = samples_of.T * np.array([1] + [2] * (size - 1))[:, None] / size
    sign = np.where(u[:, :1, 1:] > 0, -1, 1)
    period = np.concatenate([u, np.repeat(sign * u[:, :1], extra, axis=1)], axis=1)
    workspace = microslip.ElementWorkspace(1, size // 2, size)
    many = microslip.ElementArray(laws)
    jacobian = many.harmonic_force(workspace, (coefficients_of @ period).swapaxes(1, 2), index=index).jacobian
    jacobian = jacobian.reshape(items, 2, size, 2, size)
    jacobian = np.einsum("si,xaibj,jt->xsatb", samples_of[:n], jacobian, coefficients_of, optimize=True)
    jacobian[:, :, :, 0] += sign[..., None] * jacobian[:, :, :, n:].sum(axis=3)
    return force, jacobian[:, :, :, :n], None


def _differentiable(law, on_host):
    """force(displacement, changed={}) by on_host(laws, index, displacement, by_displacement, by_parameters): the forces of some
    items, and the derivatives that are wanted, by the displacement of the same item, and by all parameters.
    """
    arguments = law if isinstance(law, dict) else None

    def evaluate(displacement, changed, by_displacement, by_parameters):
        if jnp.result_type(float) != jnp.float64:
            raise ValueError('float64 is needed: jax.config.update("jax_enable_x64", True)')
        if arguments is None and changed:
            raise ValueError("parameters of a contact that exists cannot be changed: give its arguments in a dictionary")
        names = tuple(changed)
        if set(names) - set(NAMES):
            raise ValueError(f"names of parameters are {NAMES}, not {sorted(names)}")
        columns = [NAMES.index(name) for name in names]
        shape = jnp.shape(displacement)

        def call(displacement, values):
            displacement, values = np.asarray(displacement), np.asarray(values)
            items = displacement.shape[: displacement.ndim - len(shape)]
            u = displacement.reshape(-1, *shape)
            laws, index = [law], np.zeros(len(u), dtype=int)
            if arguments is not None:
                rows, index = np.unique(values.reshape(len(u), len(names)), axis=0, return_inverse=True)
                laws, index = [contact(arguments, zip(names, row.tolist())) for row in rows], index.ravel()
            force, jacobian, sensitivity = on_host(laws, index, u, by_displacement, by_parameters)
            out = [force.reshape(displacement.shape)]
            out += [jacobian.reshape(*items, *shape, *shape)] if by_displacement else []
            return out + ([np.reshape(sensitivity, (*displacement.shape, -1))[..., columns]] if by_parameters else [])

        outputs = [shape] + [shape + shape] * by_displacement + [(*shape, len(names))] * by_parameters
        return jax.pure_callback(
            call,
            [jax.ShapeDtypeStruct(output, jnp.float64) for output in outputs],
            jnp.asarray(displacement, float),
            jnp.stack([jnp.asarray(changed[name], float) for name in names]) if names else jnp.zeros(0),
            vmap_method="broadcast_all",
        )

    @jax.custom_jvp
    def force(displacement, changed):
        return evaluate(displacement, changed, False, False)[0]

    def derivative(primals, tangents):
        (displacement, changed), (du, dp) = primals, tangents
        dp = {name: d for name, d in dp.items() if not isinstance(d, SymbolicZero)}
        by_displacement = not isinstance(du, SymbolicZero)
        found, *others = evaluate(displacement, changed, by_displacement, bool(dp))
        change = jnp.zeros(found.shape)
        if by_displacement:
            change += jnp.tensordot(others.pop(0), du, axes=found.ndim)
        for name, d in dp.items():
            change += others[0][..., list(changed).index(name)] * d
        return found, change

    force.defjvp(derivative, symbolic_zeros=True)
    return lambda displacement, changed=None: force(displacement, changed or {})
