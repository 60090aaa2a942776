"""Contacts and elements as functions of JAX, with the exact derivatives of the library.

    from jax_microslip import harmonic_force
    force = harmonic_force(parameters, microslip.Workspace(5, 128))
    force(displacement, {"friction_coefficient": 0.4})  # jit, vmap, jvp, grad, jacfwd, jacrev

The library runs on the host. Arrays are float64, so JAX must be told `jax.config.update("jax_enable_x64", True)`. Items of `vmap`
are one call of the library. Derivatives are of first order: a second one is refused by JAX.
"""

import jax
import jax.numpy as jnp
import microslip
import numpy as np
from jax.custom_derivatives import SymbolicZero

# Names of parameters of a contact in the library's order of derivatives.
NAMES = [parameter.name.lower() for parameter in microslip.Parameter]


def contact(parameters, changed):
    """The `microslip.Contact` of the arguments `parameters`, some of them `changed`, which have the names of `NAMES`."""
    arguments, changed = dict(parameters), dict(changed)
    if "composite_modulus" in changed:
        modulus = changed.pop("composite_modulus")
        young_modulus = np.multiply(arguments["young_modulus"], modulus / microslip.Contact(**arguments).composite_modulus)
        arguments["young_modulus"] = young_modulus.tolist()
    if "layer_compliance" in changed:
        arguments["tangential_compliance"] = changed.pop("layer_compliance")
    return microslip.Contact(**arguments | changed)


def harmonic_force(law, workspace):
    """force(displacement, changed={}): coefficients of the force [N] in steady state, of the shape of the displacement.

    `law` is a `microslip.Contact` or `microslip.Element`; or the arguments of a contact, some of which may be `changed`:
    a dictionary of numbers with names of `NAMES`, by which the force has derivatives, too.
    """
    arguments = law if isinstance(law, dict) else None
    many, shape = microslip.ContactArray, (2 * workspace.harmonics + 1,)
    if isinstance(law, microslip.Element):
        many, shape = microslip.ElementArray, (law.directions + 1, *shape)

    def laws(names, values):
        """Contacts of the rows of `values`, each of them once, and their place for each row."""
        if arguments is None:
            return [law], np.zeros(len(values), dtype=int)
        rows, index = np.unique(values, axis=0, return_inverse=True)
        return [contact(arguments, zip(names, row.tolist())) for row in rows], index.ravel()

    def on_host(names, by_displacement, by_parameters):
        """Force, and the derivatives that are wanted, of items in any number of leading axes."""

        def call(displacement, values):
            displacement, values = np.asarray(displacement), np.asarray(values)
            items = displacement.shape[: displacement.ndim - len(shape)]
            u = displacement.reshape(-1, *shape)
            chosen, index = laws(names, values.reshape(len(u), len(names)))
            found = many(chosen).harmonic_force(workspace, u, jacobian=by_displacement, index=index)
            out = [found.force.reshape(displacement.shape)]
            if by_displacement:
                out.append(found.jacobian.reshape(*items, *shape, *shape))
            if by_parameters:
                columns = [NAMES.index(name) for name in names]
                each = [chosen[i].harmonic_sensitivity(workspace, v).sensitivity[:, columns] for i, v in zip(index, u)]
                out.append(np.reshape(each, (*items, *shape, len(names))))
            return tuple(out)

        return call

    def evaluate(displacement, changed, by_displacement, by_parameters):
        if jnp.result_type(float) != jnp.float64:
            raise ValueError('float64 is needed: jax.config.update("jax_enable_x64", True)')
        if arguments is None and changed:
            raise ValueError("parameters of a contact that exists cannot be changed: give its arguments in a dictionary")
        names = tuple(changed)
        if set(names) - set(NAMES):
            raise ValueError(f"names of parameters are {NAMES}, not {sorted(names)}")
        values = jnp.stack([jnp.asarray(changed[name], float) for name in names]) if names else jnp.zeros(0)
        outputs = [shape] + [shape + shape] * by_displacement + [(*shape, len(names))] * by_parameters
        return jax.pure_callback(
            on_host(names, by_displacement, by_parameters),
            tuple(jax.ShapeDtypeStruct(output, jnp.float64) for output in outputs),
            jnp.asarray(displacement, float),
            values,
            vmap_method="broadcast_all",
        )

    @jax.custom_jvp
    def force(displacement, changed):
        return evaluate(displacement, changed, False, False)[0]

    def derivative(primals, tangents):
        (displacement, changed), (du, dp) = primals, tangents
        dp = {name: d for name, d in dp.items() if not isinstance(d, SymbolicZero)}
        by_displacement, by_parameters = not isinstance(du, SymbolicZero), bool(dp)
        found, *others = evaluate(displacement, changed, by_displacement, by_parameters)
        change = jnp.zeros(shape)
        if by_displacement:
            change += jnp.tensordot(others.pop(0), du, axes=len(shape))
        for name, d in dp.items():
            change += others[0][..., list(changed).index(name)] * d
        return found, change

    force.defjvp(derivative, symbolic_zeros=True)
    return lambda displacement, changed=None: force(displacement, changed or {})
