"""The fields of a second opinion in JSON, from which its schema is made."""

from quasistatic_ref.formats.declared import Field, Tables

TOP, CONTACT, BODY, FINDING = "opinion", "contact", "body", "finding"
BEARING, MOTION = "bearing", "motion"
NULL = {"anyOf": [{"$ref": f"#/definitions/{BEARING}"}, {"type": "null"}]}

TABLES = Tables({
    TOP: {
        "format": Field("text", "what it is", choices=("quasistatic-ref/opinion",)),
        "version": Field("integer", "of this schema", choices=(3,)),
        "engine": Field("text", "whose answer it is about", choices=("MuJoCo", "Drake")),
        "h": Field("number", "time step of the exact answer: the engine's own", "s", above=0),
        "tolerance": Field("number", "speed up to which a contact holds", "m/s", above=0),
        "certificate": Field("text", "proof of the exact answer",
                             choices=("exact", "enclosure", "residual")),
        "contacts": Field("list of tables", "all contacts of the engine", of=CONTACT),
        "bodies": Field("list of tables", "bodies that touch and can move", of=BODY),
        "findings": Field("list of tables", "what is found; exit status 1 if any", of=FINDING),
        "left_out": Field("list of words", "what the exact answer does not have"),
    },
    CONTACT: {
        "name": Field("text", "as of the step; in MuJoCo its number and geoms"),
        "bodies": Field("list of words", "the two bodies; world for what cannot move"),
        "depth": Field("number", "by how much they penetrate", "m"),
        "mu_v": Field("number", "friction", "-", least=0),
        "mu_omega": Field("number", "torsional friction", "m", least=0),
        "pair": Field("text", "what touches, without the number of the contact"),
        "theirs": Field("table", "the engine's answer", of=BEARING),
        "exact": Field("a table or null", "null where joints or equalities bear any force",
                       schema=NULL),
    },
    BEARING: {
        "normal": Field("number", "normal force", "N"),
        "friction": Field("number", "friction force", "N", least=0),
        "torque": Field("number", "torque about the normal", "N m", least=0),
        "share": Field("number", "of what friction may be at this normal force", "-", least=0),
        "slip": Field("number", "speed of one surface along the other", "m/s", least=0),
        "spin": Field("number", "rate about the normal", "rad/s", least=0),
    },
    BODY: {
        "name": Field("text", "the engine's name"),
        "size": Field("number", "its farthest point from its centre of mass", "m", least=0),
        "rests": Field("boolean", "whether the engine has it at rest in the state itself"),
        "steady": Field("boolean", "whether the engine's motion of it stays as it is"),
        "free": Field("boolean", "whether nothing but contacts holds it"),
        "needed": Field("number", "the friction that balances its loads", "N", least=0),
        "bears": Field("number", "the sum of mu_v times normal force", "N"),
        "torque": Field("number", "moment that nothing balances", "N m"),
        "balanced": Field("boolean", "whether the engine's forces on it add up to none"),
        "theirs": Field("table", "the engine's answer, a mean over 0.1 s", of=MOTION),
        "exact": Field("table", "the exact answer, one step from rest", of=MOTION),
    },
    MOTION: {
        "speed": Field("number", "of the centre of mass", "m/s", least=0),
        "turn": Field("number", "rate of rotation", "rad/s", least=0),
        "sinks": Field("number", "speed along gravity", "m/s"),
    },
    FINDING: {
        "name": Field("text", "what is found",
                      choices=("creeps", "slides", "turns", "moves", "penetrates")),
        "grave": Field("boolean", "true"),
        "sentence": Field("text", "the remedy, then the cause"),
        "remedy": Field("text", "the option or element that changes it"),
        "numbers": Field("table", "what was measured, by names that end in the unit"),
    },
})  # fmt: skip
"""Fields by the kind of object."""
