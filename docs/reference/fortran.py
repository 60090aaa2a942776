"""Reference of the Fortran module: runs FORD, and fails if a public entity has no comment. FORD's own warnings of missing comments
would include the private interfaces to C, so they are off."""

import sys

import ford
import ford.fortran_project


def undocumented(module):
    """Names of the public entities, their arguments, results and components that have no comment."""

    def of_procedure(procedure, name):
        if not procedure.doc_list:
            yield name
        for item in [*procedure.args, *([procedure.retvar] if hasattr(procedure, "retvar") else [])]:
            if not item.doc_list:
                yield f"{name}: {item.name}"

    for item in [module, *module.variables, *module.types]:
        if not item.doc_list:
            yield item.name
    for type_ in module.types:
        for component in type_.variables:
            if component.permission == "public" and not component.doc_list:
                yield f"{type_.name}: {component.name}"
    for procedure in [*module.functions, *module.subroutines]:
        yield from of_procedure(procedure, procedure.name)
    for interface in module.interfaces:
        if interface.generic:
            if not interface.doc_list:
                yield interface.name
            for reference in interface.modprocs:
                yield from of_procedure(reference.procedure, reference.name)
        else:
            yield from of_procedure(interface.procedure, interface.name)


class Project(ford.fortran_project.Project):
    """FORD's project, checked as soon as visibility is resolved."""

    def correlate(self):
        super().correlate()
        names = [name for module in self.modules for name in undocumented(module)]
        if not self.modules or names:
            sys.exit("Without a comment: " + ", ".join(names or ["no module found"]))


ford.fortran_project.Project = Project
ford.run()
