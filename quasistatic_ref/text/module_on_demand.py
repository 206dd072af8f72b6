"""Modules that only annotations name: they are imported when ``get_type_hints`` asks for one."""

from importlib import import_module


class ModuleOnDemand:
    """A module that is imported when one of its names is read.

    Parameters
    ----------
    module : str
        Its full name.
    """

    def __init__(self, module: str) -> None:
        self._module = module

    def __getattr__(self, name: str) -> object:
        return getattr(import_module(self._module), name)
