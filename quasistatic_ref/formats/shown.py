"""Objects that show themselves: in words where they are printed, as HTML in a notebook."""

from dataclasses import fields, is_dataclass

from quasistatic_ref.parts import part


class Shown:
    """What ``optional/show`` has a page for.

    Where that part is missing, a dataclass shows its fields and any other object its class. A
    dataclass that inherits this has to be one of ``repr=False``.
    """

    def __repr__(self) -> str:
        show = part("show.pages")
        if show is not None:
            return str(show.text(self))
        if not is_dataclass(self):
            return super().__repr__()
        values = ", ".join(f"{field.name}={getattr(self, field.name)!r}" for field in fields(self))
        return f"{type(self).__name__}({values})"

    def _repr_html_(self) -> str | None:
        show = part("show.pages")
        return None if show is None else str(show.html(self))
