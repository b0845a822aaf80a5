"""Options that pyproject.toml cannot express: the wheel contains a library for one platform and any Python 3."""

from setuptools import Distribution, setup
from wheel.bdist_wheel import bdist_wheel


class OfOneMachine(Distribution):
    def has_ext_modules(self):
        return True


class AnyPython(bdist_wheel):
    def get_tag(self):
        return ("py3", "none", super().get_tag()[2])


setup(distclass=OfOneMachine, cmdclass={"bdist_wheel": AnyPython})
