"""Settings of the documentation site for Sphinx; tools/docs writes the sources and runs it."""

from pygments.lexers.data import JsonLexer
from sphinx.domains.cpp import CPPDomain

project = "Vinerow"
copyright = "the Vinerow authors, BSD-3-Clause"
extensions = ["myst_parser"]
myst_heading_anchors = 6
# Comments and listings are shown as written; most blocks without a language are output of commands.
smartquotes = False
highlight_language = "none"
primary_domain = "cpp"

html_theme = "furo"
html_title = "Vinerow"
html_static_path = ["custom.css", "custom.js"]
html_css_files = ["custom.css"]
html_js_files = ["custom.js"]
html_copy_source = False
html_show_sourcelink = False
html_show_sphinx = False
html_last_updated_fmt = None
html_theme_options = {
    "light_css_variables": {
        "color-brand-primary": "#4d6b1f",
        "color-brand-content": "#3c6a9e",
        "color-sidebar-link-text--top-level": "#3f4349",
        "color-api-name": "#7a2e3b",
        "color-api-pre-name": "#7a2e3b",
        "color-problematic": "#7a2e3b",
    },
    "dark_css_variables": {
        "color-brand-primary": "#a9c77d",
        "color-brand-content": "#7fb2e5",
        "color-sidebar-link-text--top-level": "#c6cad0",
        "color-api-name": "#e8a0ac",
        "color-api-pre-name": "#e8a0ac",
        "color-problematic": "#e8a0ac",
    },
}
pygments_style = "friendly"
pygments_dark_style = "native"


class NamedEntities(CPPDomain):
    """C++ without parameters of functions and templates, which would fill the results of a search."""

    def get_objects(self):
        return (entry for entry in super().get_objects() if entry[2] not in ("functionParam", "templateParam"))


def setup(app):
    app.add_domain(NamedEntities, override=True)
    app.add_lexer("geojson", JsonLexer)
