"""What a certificate claims, in words."""

from quasistatic_ref.certify.curved_cone import curved_cone
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.solution import Certificate


def in_words(certificate: Certificate) -> str:
    """What a certificate claims of its step, in a sentence or two."""
    if certificate.kind == "residual":
        worst = max(certificate.residuals.values())
        return f"not proved: worst residual {worst:.1e} in natural units"
    if certificate.kind == "enclosure":
        bound = f"at most {certificate.error_bound:.1e}, proved in ball arithmetic"
        return f"enclosed: the relative error of delta_q in the norm of H is {bound}"
    if certificate.kind != "exact":
        return "nothing is certified"
    step = certificate.step
    assert step is not None
    if not cone(step.cone).polyhedral:
        return curved_cone(step).in_words(certificate)
    words = [
        "exact: the optimum of the step, correctly rounded",
        f"working set: {len(certificate.active)} of {step.m} rows",
        "multipliers unique" if certificate.multipliers_unique else "multipliers not unique",
        f"delta_q {'' if certificate.differentiable else 'not '}differentiable with respect to "
        "forces and targets",
    ]
    if certificate.smallest_inactive_slack is not None:
        words.append(f"smallest inactive slack {certificate.smallest_inactive_slack:.1e} m")
    if certificate.smallest_active_multiplier is not None:
        words.append(f"smallest active multiplier {certificate.smallest_active_multiplier:.1e} N s")
    return "; ".join(words)
