"""Contacts and elements as functions of JAX, with the exact derivatives of the library.

    from jax_microslip import harmonic_force
    force = harmonic_force(parameters, microslip.Workspace(5, 128))
    force(displacement, {"friction_coefficient": 0.4})  # jit, vmap, jvp, grad, jacfwd, jacrev

`harmonic_force` returns force(displacement, changed={}); the force [N] has the shape of the displacement. Its law is a
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
            found = many(laws).harmonic_force(workspace, u, jacobian=by_displacement, index=index)
            out = [found.force.reshape(displacement.shape)]
            if by_displacement:
                out.append(found.jacobian.reshape(*items, *shape, *shape))
            if by_parameters:
                each = [laws[i].harmonic_sensitivity(workspace, v).sensitivity for i, v in zip(index, u)]
                out.append(np.reshape(each, (*displacement.shape, -1))[..., columns])
            return out

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
