"""The names of ``qr.figures`` as type checkers see them; `figures.py` reads them, too."""

from quasistatic_ref.optional.show.figures.contact_pictures import stick_slip_map as stick_slip_map
from quasistatic_ref.optional.show.figures.friction_cone import cone_with_load as cone_with_load
from quasistatic_ref.optional.show.figures.moments import moment as moment
