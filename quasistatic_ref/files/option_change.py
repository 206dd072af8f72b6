"""Changes of a scenario that options of a command make."""


class OptionChange(str):
    """A change that an option of a command makes: ``solver.backend="osqp"`` for ``--backend osqp``.

    Parameters
    ----------
    text : str
        The change, as ``--set`` has it.
    option : str
        What the user wrote.
    """

    option: str

    def __new__(cls, text: str, option: str = "") -> "OptionChange":
        """The text; a copy of a pickle is given its option afterwards."""
        change = super().__new__(cls, text)
        change.option = option
        return change
