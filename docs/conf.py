"""How the documentation is built: ``python -m sphinx -W -n docs OUT``, without network.

Nothing that a page loads comes from elsewhere: MathJax is a Python package whose files are copied,
and the theme brings its own fonts and scripts. ``python -m validation.tools.check_in_browser OUT``
proves it.
"""

import pkgutil
import re
import sys
from importlib.util import find_spec
from pathlib import Path

from docutils import nodes
from sphinx.ext import autosummary
from sphinx.util.nodes import make_refnode

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

import quasistatic_ref  # noqa: E402 the path has to be there first
from docs.fields_page import arrays_page, options_page, reference_page  # noqa: E402 the path has to be there first
from quasistatic_ref import __version__  # noqa: E402 the path has to be there first
from quasistatic_ref.cli.main import COMMANDS, _actions, command_parser  # noqa: E402 the path has to be there first
from quasistatic_ref.files import solution, trajectory  # noqa: E402 the path has to be there first
from quasistatic_ref.files.scenario import scenario_table  # noqa: E402 the path has to be there first
from quasistatic_ref.step import text as step_text  # noqa: E402 the path has to be there first

FIELDS = {
    "scenario": scenario_table.TABLES,
    "step": step_text.TABLES,
    "solution": solution.TABLES,
    "header": trajectory.TABLES,
}
"""The tables of a kind of file, for pages that list its fields."""

project = "quasistatic_ref"
author = "The quasistatic_ref developers"
project_copyright = author
version = release = __version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.doctest",
    "sphinx.ext.mathjax",
    "sphinx.ext.napoleon",
    "sphinx.ext.viewcode",
    "sphinx_copybutton",
    "sphinx_gallery.gen_gallery",
    "sphinxcontrib.bibtex",
    "sphinx-mathjax-offline",  # MathJax 3, copied into _static
]
exclude_patterns = ["examples", "figures", "gallery", "notebooks", "slides", "_build"]
nitpicky = True

# -- Pages ---------------------------------------------------------------------------------------
html_theme = "furo"
html_title = f"quasistatic_ref {version}"
templates_path = ["_templates"]
html_static_path = ["_static"]
html_extra_path = ["draggable"]  # a page of its own
viewcode_follow_imported_members = False
html_css_files = ["page.css"]
html_show_sphinx = False
# Furo's button fonts are the system's; its icons are inline. There is nothing to fetch.
html_theme_options = {"navigation_with_keys": True}

myst_enable_extensions = ["attrs_inline", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
myst_links_external_new_tab = False

# -- Listings ------------------------------------------------------------------------------------
# A copy has the lines behind prompts, without the prompts, and not what was printed.
copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True

# -- Equations -----------------------------------------------------------------------------------
# The labels eq-1 .. eq-13 stand in one page and in order, so that Sphinx's own numbers (1) .. (13)
# are the paper's. The traceability test holds that.
math_numfig = False
math_eqref_format = "({number})"

# -- Docstrings ----------------------------------------------------------------------------------
# Types of arguments are prose with shapes ("ndarray, shape (n_c, 3)"): shown, not looked up.
napoleon_google_docstring = False
napoleon_use_param = False
napoleon_use_rtype = False
napoleon_use_ivar = True
autosummary_generate = True  # api/names, at each build
autosummary.WELL_KNOWN_ABBREVIATIONS += ("Eq.", "Eqs.")  # which end no sentence
autodoc_member_order = "bysource"
autodoc_typehints = "none"
autodoc_default_options = {"members": True, "show-inheritance": True}
# Engines that are optional and differ in what they run on; only `validate` talks to them. And a
# solver under the GPL, of which a page shows no more than its adapter's name.
autodoc_mock_imports = ["mujoco", *([] if find_spec("quadprog") else ["quadprog"])]
# There is no network at build time, hence no inventory to look third-party names up in.
nitpick_ignore_regex = [
    (r"py:.*", r"(numpy|scipy|cvxpy|clarabel|flint|pinocchio|coal|matplotlib|mujoco)\..*"),
    # Bases of classes in the standard library, for the same reason.
    (r"py:.*", r"(abc|argparse|collections|concurrent|contextlib|enum|fractions|json)\..*"),
    (r"py:.*", r"(pathlib|subprocess|types|typing)\..*"),
    (r"py:(class|exc|obj)", r"(object|Exception|ValueError|TypeError|ImportError|RuntimeError)"),
    (r"py:obj", r"quasistatic_ref\..*\.(T|Number)"),  # any type, of a generic class
]

# -- Figures and literature ----------------------------------------------------------------------
sphinx_gallery_conf = {
    "examples_dirs": "gallery",
    "gallery_dirs": "scripts",  # written at each build
    "filename_pattern": r"\.py$",
    "within_subsection_order": "docs.gallery_order.OrderOfReadme",
    "download_all_examples": False,
    "show_memory": False,
    "write_computation_times": False,  # its page loads scripts from elsewhere
    "show_signature": False,
    "min_reported_time": 10_000,
    "reset_modules": ("docs.gallery_order.in_style_of_pages",),
}
bibtex_bibfiles = ["references.bib"]
bibtex_default_style = "plain"

# -- Doctests ------------------------------------------------------------------------------------
# Pages import what they use; docstrings of single functions are shown without their imports.
doctest_global_setup = """
from fractions import Fraction
import numpy as np
import quasistatic_ref as qr
from quasistatic_ref.exact.digits import digits_of_error
from quasistatic_ref.cli.decimals import decimal_string
np.set_printoptions(precision=8, suppress=False)  # a page before may have changed these
"""


CLOSED_FORMS = (
    "derivations", "exactness", "cones", "derivatives", "extensions", "artifacts", "studies",
)  # fmt: skip
"""The pages in which results (R1), (R2), ... are derived, each in bold where it begins."""
RESULT = re.compile(r"\*\*\((R\d+)\)([^*]*)\*\*")
KEPT = re.compile(
    r"(^```.*?^```$|\$\$.+?\$\$|\$[^$]+\$|`[^`\n]+`|\[[^\]]*\]\{#r\d+\}|\[\(R\d+\)\]\([^)]*\))",
    re.MULTILINE | re.DOTALL,
)
"""What of a page is no prose: fences, literals, formulas, results where they begin, links."""
INCLUDED = {
    "validation/results/claims.md": "included/claims.md",
    "validation/vectors/README.md": "included/vectors.md",
    "validation/contact_qp/README.md": "included/contact_qp.md",
}
"""Pages of the repository that are pages of the site too: where they are, and where here."""
CONTENTS = {
    "Begin": (
        "quickstart", "course/one_contact", "course/from_coulomb", "course/springs_and_steps",
        "course/the_bunny", "course/a_patch_that_slides", "course/exercises", "course/teachers",
        "scripts/index",
    ),
    "The model": (
        "theory/equations", "theory/errata", "conventions", "derivations", "cones",
        "artifacts", "theory/references",
    ),
    "Proofs and derivatives": ("exactness", "exact_qp", "derivatives"),
    "Evidence": ("included/claims", "reality"),
    "Use": (
        "guides/first_scene", "guides/does_my_contact_hold", "guides/write_a_scenario",
        "guides/in_python", "findings", "stands", "guides/runs", "guides/file_formats", "speed",
        "extensions", "guides/check_your_implementation", "included/vectors", "studies",
        "included/contact_qp", "api/index",
    ),
    "Work on it": ("read_a_step", "contributing", "adding", "libraries"),
}  # fmt: skip
"""The parts of the site and their pages, in the order of its navigation."""
INDEXED = {
    "artifacts": {"## The drag of a run": "Pi", "## The time step": "time step"},
    "conventions": {"## One step, as solvers see it": "lam"},
    "guides/check_your_implementation": {"# Check your implementation": "port"},
    "quickstart": {"## Install": "licence"},
}
"""Headings that readers should find by a word which stands in many pages, or in none."""
CITED_RESULT = re.compile(r"\((R\d+)\)")
NAMED_EQUATIONS = re.compile(r"\bEqs?\. \(\d+\)(?:(?: to |, | and )\(\d+\))*")
WORK = re.compile(r"\[[^\]]*\]\([./]*references\.bib#(\w+)\)")
SENTENCE = 20
"""Letters from which on a cell of a table holds more than a name or a number."""
TABLES = re.compile(r"^\[The tables\]\((\S+)\)$", re.MULTILINE)
"""A line that leads to committed tables, which stand on the site in its place."""
OUTSIDE = re.compile(
    r"\[([^\]]+)\]\(((?:\.\./)+(?:validation|slides|quasistatic_ref)/[^)#]+\.md)\)"
)
"""A link to Markdown that is no page of the site: it is downloaded."""
CITED_EQUATION = re.compile(r":eq:`eq-(\d+)`")
CITED_NAME = re.compile(r":(?:class|func|meth|attr|mod):`~?(?:\w+\.)*(\w+)`")


def setup(app):
    """What pages say in one line and the site says at length."""
    for file, page in INCLUDED.items():
        include = f"```{{include}} ../../{file}\n:relative-images:\n```\n"
        made = ROOT / "docs" / page
        made.parent.mkdir(exist_ok=True)
        if not made.is_file() or made.read_text("utf-8") != include:
            made.write_text(include, encoding="utf-8")
    # It copies files when all is built, and says nothing about reading in parallel.
    app.extensions["sphinx-mathjax-offline"].parallel_read_safe = True
    app.connect("source-read", _expanded)
    app.connect("doctree-read", _plain_listings)
    app.connect("doctree-read", _thumbnails_named)
    app.connect("doctree-read", _prose_tables_marked)
    app.connect("autodoc-process-docstring", _kept, priority=400)  # napoleon's is 500
    app.connect("autodoc-process-docstring", _mended, priority=600)
    app.connect("missing-reference", _public)
    app.connect("html-page-context", _navigation_kept, priority=400)  # furo's is 500


def _expanded(app, docname, source):
    """Pages are plain Markdown, which a code host shows; here links lead to pages of the site.

    ``<!-- contents -->`` is the navigation, ``<!-- fields of a scenario -->`` and ``<!-- arrays of
    a trajectory -->`` are the tables by which these are read.
    """
    up = "../" * docname.count("/")
    text = source[0]
    if docname.startswith("scripts/"):  # reStructuredText, in which code is indented
        source[0] = "".join(
            line if line[:1].isspace() else _prose_linked(line)
            for line in text.splitlines(keepends=True)
        )
        return
    for file, page in INCLUDED.items():
        text = text.replace(f"]({up}../{file})", f"]({up}{page})")
    text = TABLES.sub(r"```{include} \1\n:heading-offset: 1\n```", text)
    text = OUTSIDE.sub(r"{download}`\1 <\2>`", text)
    text = WORK.sub(r"{cite:t}`\1`", text)
    text = text.replace("<!-- contents -->", _contents())
    for heading, words in INDEXED.get(docname, {}).items():
        text = text.replace(f"{heading}\n", f"{heading}\n\n```{{index}} ! {words}\n```\n", 1)
    text = text.replace(f"]({up}gallery/README.md)", f"]({up}scripts/index.rst)")
    for kind, tables in FIELDS.items():
        text = text.replace(f"\n<!-- fields of a {kind} -->\n", "\n" + reference_page(tables))
    text = text.replace("\n<!-- arrays of a trajectory -->\n", "\n" + arrays_page())
    options = options_page(_actions(command_parser(COMMANDS)))
    text = text.replace("\n<!-- options of commands -->\n", "\n" + options)
    if docname in CLOSED_FORMS:
        text = RESULT.sub(lambda r: f"[**({r[1]}){r[2]}**]{{#{r[1].lower()}}}", text)
    source[0] = _results_linked(text)


def _contents():
    """A table of contents for each part of the site."""
    return "\n\n".join(
        "\n".join(["```{toctree}", ":hidden:", f":caption: {caption}", "", *pages, "```"])
        for caption, pages in CONTENTS.items()
    )


def _results_linked(text):
    """(R7) and Eq. (9) in prose lead to where they stand; fences, literals and formulas stay."""
    parts = KEPT.split(text)
    parts[::2] = (
        NAMED_EQUATIONS.sub(
            lambda equations: re.sub(r"\((\d+)\)", r"{eq}`eq-\1`", equations[0]),
            CITED_RESULT.sub(lambda r: f"[({r[1]})](#{r[1].lower()})", part),
        )
        for part in parts[::2]
    )
    return "".join(parts)


def _plain_listings(app, doctree):
    """In quoted source, references read as on a page: (4) for an equation, a name for a class."""
    for listing in doctree.findall(nodes.literal_block):
        text = CITED_NAME.sub(r"\1", CITED_EQUATION.sub(r"(\1)", listing.astext()))
        listing.rawsource, listing.children = text, [nodes.Text(text)]


def _thumbnails_named(app, doctree):
    """A thumbnail of the gallery's index says for those who do not see it what it leads to."""
    if app.env.docname != "scripts/index":
        return
    for image in doctree.findall(nodes.image):
        name = re.sub(r"^sphx_glr_(\w+)_thumb$", r"\1", Path(image["uri"]).stem)
        image["alt"] = f"figure of the script: {name.replace('_', ' ')}"


def _prose_tables_marked(app, doctree):
    """Tables of sentences in many columns: on a phone their columns are wide, and scroll."""
    for table in doctree.findall(nodes.table):
        for row in table.findall(nodes.row):
            lengths = [len(entry.astext()) for entry in row.findall(nodes.entry)]
            if len(lengths) > 3 and sorted(lengths[-3:])[1] > SENTENCE:
                table["classes"].append("sentences")
                break


_navigations = {}


def _navigation_kept(app, pagename, templatename, context, doctree):
    """Listings of one depth have the same navigation: to make it takes longer than all the rest."""
    if pagename.startswith("_modules/"):
        depth = pagename.count("/")
        made = context["toctree"]

        def kept(**options):
            if depth not in _navigations:
                _navigations[depth] = made(**options)
            return _navigations[depth]

        context["toctree"] = kept


def _public(app, env, node, contnode):
    """A name of the package leads to the page of the public name, or is shown as it is.

    Docstrings name modules; pages are of public names. A name that does not exist stays an error.
    """
    path = node.get("reftarget", "")
    name = path.rpartition(".")[2]
    if not path.startswith("quasistatic_ref."):
        return None
    figures = quasistatic_ref.figures.__all__
    if name != "figures" and name in {*quasistatic_ref.__all__, *figures}:
        home = "quasistatic_ref.figures" if name in figures else "quasistatic_ref"
        place = env.get_domain("py").objects[f"{home}.{name}"]
        return make_refnode(app.builder, node["refdoc"], place.docname, place.node_id, contnode)
    return contnode if _exists(path) else None


def _exists(path):
    """Whether a dotted path is a module, or an attribute of one or of its class."""
    try:
        pkgutil.resolve_name(path)
    except (ImportError, AttributeError):
        module, _, field = path.rpartition(".")
        owner = pkgutil.resolve_name(module) if module.count(".") > 1 else None
        return field in getattr(owner, "__annotations__", {})
    return True


# -- Docstrings are read in the source first: some habits of theirs are no markup ---------------
UNDERLINE = re.compile(r"^-{3,}$", re.MULTILINE)
LITERAL = re.compile(r"(``.*?``)")
_one_liners = {}


def _kept(app, what, name, obj, options, lines):
    """A value's docstring is prose: what stands before its first colon is not its type."""
    if what in ("data", "attribute", "property") and not UNDERLINE.search("\n".join(lines)):
        _one_liners[name] = list(lines)


def _mended(app, what, name, obj, options, lines):
    """|x| is a magnitude; and types of attributes are prose, as those of parameters."""
    lines[:] = _one_liners.pop(name, lines)
    types = dict(m.groups() for line in lines if (m := re.match(r":vartype ([^:]+): (.*)", line)))
    kept = [line for line in lines if not line.startswith(":vartype ")]
    in_math = False
    mended = []
    for line in kept:
        in_math = line.startswith(".. math::") or (in_math and (not line or line.startswith(" ")))
        if (found := re.match(r":ivar ([^:]+):", line)) and (names := found.group(1)) in types:
            # "a, b" without its space: the word before a space would be taken for a type.
            line = f":ivar {names.replace(', ', ',')}: *{types[names]}* {line[found.end() :]}"
        mended.append(line if in_math else _bars(line))
    lines[:] = mended


def _bars(line):
    """Vertical bars escaped, and results linked, except in literals."""
    parts = LITERAL.split(line)
    return "".join(p if p.startswith("``") else _prose(p) for p in parts)


def _prose(text):
    return _prose_linked(text).replace("|", "\\|")


def _prose_linked(text):
    """Results in reStructuredText lead to where they are derived."""
    return CITED_RESULT.sub(lambda r: f":ref:`({r[1]}) <{r[1].lower()}>`", text)
