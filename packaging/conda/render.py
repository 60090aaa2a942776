"""render.py RECIPE [DIRECTORY TARBALL]: renders the recipe, and builds and tests the package if there is a directory for it.

The package is built from the tarball, which need not be published yet, and without the dependencies of the recipe, which are in the
channel: with the compilers of this machine.
"""

import io
import sys

import ruamel.yaml
from rattler_build import EnvironmentIsolation, Package, Stage0Recipe, ToolConfiguration, VariantConfig

# What the channel chooses.
VARIANTS = VariantConfig({"c_compiler": ["gcc"], "c_stdlib": ["sysroot"], "rust_compiler": ["rust"]})

recipe, *build = sys.argv[1:]
(rendered,) = Stage0Recipe.from_file(recipe).render(VARIANTS)
assert len(rendered.recipe.requirements.to_dict()["build"]) == 4, "a dependency is missing"
if build:
    directory, tarball = build
    yaml = ruamel.yaml.YAML()
    with open(recipe, encoding="utf-8") as file:
        content = yaml.load(file)
    content["source"]["url"] = f"file://{tarball}"
    del content["requirements"]
    for test in content["tests"]:
        test.pop("requirements", None)
    text = io.StringIO()
    yaml.dump(content, text)
    (variant,) = Stage0Recipe.from_yaml(text.getvalue()).render(VARIANTS)
    # The contents are tested in the build. The only channel is the directory: an empty list would stand for conda-forge.
    channel = [f"file://{directory}"]
    result = variant.run_build(
        ToolConfiguration(test_strategy="skip"), directory, channels=channel, env_isolation=EnvironmentIsolation.NONE
    )
    (tested,) = Package.from_file(result.packages[0]).run_tests(channel=channel)
    assert tested.success, "\n".join(tested.output)
