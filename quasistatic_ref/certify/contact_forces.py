"""Forces of single contacts, as ``optional/forces`` finds them."""

from dataclasses import dataclass

from quasistatic_ref.formats.shown import Shown
from quasistatic_ref.numbers.arrays import Array, read_only


@dataclass(frozen=True, eq=False, repr=False)
class ContactForces(Shown):
    """The forces of a step's contacts.

    Parameters
    ----------
    wrench : ndarray, shape (n_c, 4)
        (f_d1, f_d2, f_n, tau_n) on beta's body [N, N m].
    delta_q : ndarray, shape (n_v,)
        Where the step with compliance ends [m, rad].
    compliance : ndarray, shape (n_c,)
        c of each contact [m/N].
    imbalance : float
        The share of the load that the forces leave, the largest of all groups [-]: they balance
        the step at `delta_q`, not at the displacement x of the step without compliance. It is
        ||delta_q - x||_H over the norm ||h J'f||_{H^-1} of what the forces f exert; infinite where
        this is zero, as of a step without solution.
    sensitivity : float
        At most how much a force changes if each phi of its group changes by 1 m, over the sum of
        the group's normal forces, (R42), the largest of all groups [1/m].

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> qr.contact_forces(step).imbalance < 1e-6
    True
    """

    wrench: Array
    delta_q: Array
    compliance: Array
    imbalance: float
    sensitivity: float

    def __post_init__(self) -> None:
        for array in (self.wrench, self.delta_q, self.compliance):
            read_only(array)
