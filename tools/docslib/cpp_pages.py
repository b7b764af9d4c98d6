"""Pages of the C++ interface: docs/reference/cpp.md names the headers, Doxygen's XML has their contents."""

import re
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path

from docslib.errors import DocsError
from docslib.headers import compounds

PAGE = "docs/reference/cpp.md"
ROW = re.compile(r"^\| \[`([^`]+)`\]\(([^)]+)\) \|", re.MULTILINE)
CLASSES = ("class", "struct", "union")
TITLES = {"return": "Returns", "pre": "Precondition", "post": "Postcondition", "note": "Note", "warning": "Warning", "see": "See"}


@dataclass
class Group:
    """A section of docs/reference/cpp.md, and a page of the site."""
    title: str
    text: str
    headers: list[str] = field(default_factory=list)  # as installed

    @property
    def name(self) -> str:
        return re.sub(r"\W+", "_", self.title.lower())


def groups_of(page: str, headers: dict[str, str]) -> list[Group]:
    """@param headers  path in the repository -> path in the package; each must be in one group."""
    groups, faults, seen = [], [], set()
    for section in re.split(r"^## ", page, flags=re.MULTILINE)[1:]:
        title, _, body = section.partition("\n")
        group = Group(title.strip(), body.split("\n|", 1)[0].strip())
        for name, path in ROW.findall(body):
            if headers.get(path.removeprefix("../../")) != name:
                faults.append(f"{PAGE}: {name} is not the installed name of {path}")
            if name in seen:
                faults.append(f"{PAGE}: {name} is listed twice")
            seen.add(name)
            group.headers.append(name)
        groups.append(group)
    faults += [f"{PAGE}: {name} is missing" for name in headers.values() if name not in seen]
    if faults:
        raise DocsError("\n".join(faults))
    return groups


def escaped(text: str) -> str:
    return re.sub(r"([\\*`|_<>:])", r"\\\1", re.sub(r"\s+", " ", text))


def flat(node: ElementTree.Element | None) -> str:
    """Text of a type or an argument list, in the project's spelling of templates."""
    text = re.sub(r"\s+", " ", "".join(node.itertext())).strip() if node is not None else ""
    return re.sub(r"\s+>", ">", re.sub(r"<\s+", "<", text))


def listing(node: ElementTree.Element) -> str:
    lines = []
    for line in node.iter("codeline"):
        for space in line.iter("sp"):
            space.text = " "
        lines.append("".join(line.itertext()))
    indent = min((len(line) - len(line.lstrip()) for line in lines if line.strip()), default=0)
    return ".. code-block:: cpp\n\n" + "\n".join("   " + line[indent:] for line in lines)


def inline(node: ElementTree.Element) -> str:
    """A paragraph without the blocks in it."""
    text = escaped(node.text or "")
    for child in node:
        if child.tag == "computeroutput":
            # The escaped spaces vanish; they let letters touch the markup.
            code = re.sub(r"\s+", " ", "".join(child.itertext())).strip()
            text += f"\\ ``{code}``\\ "
        elif child.tag in ("emphasis", "bold"):
            mark = "*" if child.tag == "emphasis" else "**"
            text += f"\\ {mark}{escaped(''.join(child.itertext())).strip()}{mark}\\ "
        elif child.tag in ("ndash", "mdash"):
            text += "-"
        elif child.tag not in ("parameterlist", "simplesect", "programlisting", "itemizedlist", "orderedlist"):
            text += inline(child)
        text += escaped(child.tail or "")
    return text


def indented(text: str, spaces: int = 3) -> str:
    return "\n".join(" " * spaces + line if line else "" for line in text.split("\n"))


def exception(name: str) -> str:
    """A type, or the first word of a sentence."""
    return f"``{name.strip(';,')}``" if name[0].isupper() else escaped(name)


def blocks(node: ElementTree.Element | None) -> list[str]:
    """A description as blocks of reStructuredText."""
    found = []
    for paragraph in node if node is not None else ():
        if paragraph.tag != "para":
            continue
        text = inline(paragraph).strip()
        if text:
            found.append(text)
        for child in paragraph:
            if child.tag == "programlisting":
                found.append(listing(child))
            elif child.tag in ("itemizedlist", "orderedlist"):
                mark = "- " if child.tag == "itemizedlist" else "#. "
                items = ["\n\n".join(blocks(item)) for item in child.findall("listitem")]
                found.append("\n".join(mark + indented(item, len(mark)).lstrip() for item in items))
            elif child.tag == "simplesect":
                body = " ".join(blocks(child))
                found.append(f":{TITLES.get(child.get('kind'), child.get('kind'))}: {body}")
            elif child.tag == "parameterlist":
                items = [(["".join(name.itertext()) for name in item.iter("parametername")],
                          " ".join(blocks(item.find("parameterdescription")))) for item in child.findall("parameteritem")]
                if child.get("kind") == "exception":
                    found += [f":Throws: {', '.join(map(exception, names))} {body}".rstrip() for names, body in items]
                else:
                    lines = [f"{', '.join(f'``{name}``' for name in names)}: {body}" for names, body in items]
                    found.append(":Parameters:\n" + indented("\n\n".join(lines)))
    return found


def description(node: ElementTree.Element) -> str:
    return "\n\n".join(blocks(node.find("briefdescription")) + blocks(node.find("detaileddescription")))


def template_of(node: ElementTree.Element) -> str:
    parameters = node.find("templateparamlist")
    if parameters is None:
        return ""
    names = []
    for parameter in parameters:
        text = " ".join(filter(None, (flat(parameter.find("type")), flat(parameter.find("declname")))))
        default = flat(parameter.find("defval"))
        names.append(text + (f" = {default}" if default else ""))
    requires = flat(node.find("requiresclause"))
    if requires.startswith("requires"):  # an expression of its own, which the C++ domain does not parse
        requires = ""
    return f"template <{', '.join(names)}> " + (f"requires {requires} " if requires else "")


def directive(kind: str, signature: str, body: str) -> str:
    return f".. cpp:{kind}:: {signature}\n" + (f"\n{indented(body)}\n" if body else "")


def contents(bodies: list[str]) -> str:
    """Links to the entities of a header, if they are many."""
    names = []
    for body in bodies:
        found = re.match(r"\.\. cpp:(?:class|struct|enum|enum-class|type|concept|function):: (.*)", body)
        signature = re.sub(r"^template <.*?> (?=\w)|(?<=[\w>])\(.*| : .*| = .*", "", found.group(1)) if found else ""
        name = re.search(r"[\w:]+$", signature)
        if name and "operator" not in name.group(0) and name.group(0) not in names:
            names.append(name.group(0))
    return "Contents: " + ", ".join(f":cpp:any:`{name}`" for name in names) + "\n" if len(names) > 2 else ""


class Reference:
    """All entities by the header that declares them."""

    def __init__(self, xml: Path):
        self.compounds = {compound.get("id"): compound for compound in compounds(xml)}

    def header(self, name: str) -> tuple[str, str]:
        """Description of a header and its contents with links to them, as reStructuredText."""
        text, found = "", []
        for compound in self.compounds.values():
            if compound.get("kind") == "file" and compound.find("location").get("file") == name:
                text = description(compound)
                found += self.members(compound, name, "", kinds=("define",))
            elif compound.get("kind") == "namespace" and self.is_public(compound):
                found += self.members(compound, name, in_vinerow(compound.findtext("compoundname")))
            elif compound.get("kind") == "concept" and compound.find("location").get("file") == name:
                initializer = flat(compound.find("initializer"))
                signature = re.sub(r"\s*concept .*", "", initializer) + f" {in_vinerow(compound.findtext('compoundname'))}"
                found.append((int(compound.find("location").get("line")),
                              directive("concept", signature, description(compound))))
            elif compound.get("kind") in CLASSES and compound.find("location").get("file") == name and \
                    not self.is_nested(compound) and self.is_public(compound):
                found.append((int(compound.find("location").get("line")),
                              self.class_text(compound, in_vinerow(compound.findtext("compoundname")))))
        bodies = [body for _, body in sorted(found, key=lambda entry: entry[0])]
        return text, "\n".join([".. cpp:namespace:: vinerow\n", contents(bodies), *bodies])

    def is_nested(self, compound: ElementTree.Element) -> bool:
        outer = compound.findtext("compoundname").split("<")[0].rpartition("::")[0]
        return any(other.findtext("compoundname") == outer and other.get("kind") in CLASSES
                   for other in self.compounds.values())

    @staticmethod
    def is_public(compound: ElementTree.Element) -> bool:
        name = compound.findtext("compoundname")
        return name.split("::")[0] == "vinerow" and "::@" not in name and "::parameter_rows" not in name

    def class_text(self, compound: ElementTree.Element, name: str) -> str:
        bases = ", ".join(f"{base.get('prot')} {in_vinerow(flat(base))}" for base in compound.findall("basecompoundref"))
        found = self.members(compound, "", name)
        for inner in compound.findall("innerclass"):
            nested = self.compounds.get(inner.get("refid"))
            if inner.get("prot") == "public" and nested is not None:
                place = int(nested.find("location").get("line"))
                found.append((place, self.class_text(nested, nested.findtext("compoundname").rpartition("::")[2])))
        body = "\n".join(text for _, text in sorted(found, key=lambda entry: entry[0]))
        signature = f"{template_of(compound)}{flat_name(name)}" + (f" : {bases}" if bases else "")
        return directive(compound.get("kind"), signature, "\n\n".join(filter(None, (description(compound), body))))

    def members(self, compound: ElementTree.Element, header: str, scope: str, kinds: tuple[str, ...] = ()) -> \
            list[tuple[int, str]]:
        found = []
        in_class = compound.get("kind") in CLASSES
        for member in compound.iter("memberdef"):
            location = member.find("location")
            if kinds and member.get("kind") not in kinds or header and location.get("file") != header:
                continue
            if member.get("prot") in ("private", "package") or member.get("kind") == "friend":
                continue
            text = self.member(member, "" if in_class or not scope else f"{scope}::", compound)
            if text:
                found.append((int(location.get("line")), text))
        return found

    def member(self, member: ElementTree.Element, scope: str, compound: ElementTree.Element) -> str:
        kind, name, type_ = member.get("kind"), member.findtext("name"), flat(member.find("type"))
        text, arguments = description(member), flat(member.find("argsstring"))
        initializer = flat(member.find("initializer"))
        if kind == "define":
            parameters = [flat(parameter.find("defname")) for parameter in member.findall("param")]
            return f".. c:macro:: {name}" + (f"({', '.join(parameters)})" if parameters else "") + \
                f"\n\n{indented(text)}\n"
        if kind == "enum":
            values = "\n".join(directive("enumerator", value.findtext("name"), description(value))
                               for value in member.findall("enumvalue"))
            base = f" : {type_}" if type_ else ""
            return directive("enum-class" if member.get("strong") == "yes" else "enum", f"{scope}{name}{base}",
                             "\n\n".join(filter(None, (text, values))))
        if kind == "typedef":
            value = re.sub(r"^using \S+ = ?", "", flat(member.find("definition")).removeprefix(template_of(member)))
            return directive("type", f"{template_of(member)}{scope}{name} = {type_ or value}", text)
        if kind == "variable":
            prefix = "static " if member.get("static") == "yes" and "static" not in type_ else ""
            if "{." in initializer.replace(" ", "") or len(initializer) > 60:  # the C++ domain parses no designators
                initializer = ""
            value = f" = {initializer.removeprefix('=').strip()}" if initializer else ""
            space = "" if type_.endswith("(*") else " "  # pointer to function: the arguments follow the name
            return directive("member", f"{template_of(member)}{prefix}{type_}{space}{scope}{name}{arguments}{value}", text)
        if kind != "function" or type_.startswith(("template ", "extern template")):
            return ""
        class_name = compound.findtext("compoundname").split("<")[0].rpartition("::")[2]
        special = name in (class_name, f"~{class_name}", "operator=")
        if special and not text and (name.startswith("~") or f"{class_name} &" in arguments or
                                     f"{class_name}&" in arguments):
            return ""
        prefix = "".join(f"{word} " for word, attribute in
                         (("static", "static"), ("explicit", "explicit")) if member.get(attribute) == "yes")
        prefix += "virtual " if member.get("virt") != "non-virtual" and "override" not in arguments else ""
        arguments = re.sub(r"=\s*0$", " = 0", re.sub(r"=default$", " = default", arguments))
        arguments = re.sub(r"=delete$", " = delete", arguments)
        signature = f"{template_of(member)}{prefix}{type_} {scope}{name}{arguments}"
        return directive("function", re.sub(r"\s+", " ", signature), text)


def in_vinerow(name: str) -> str:
    """A name as it is written inside the namespace; empty for the namespace itself."""
    return name.removeprefix("vinerow").removeprefix("::")


def flat_name(name: str) -> str:
    return re.sub(r"\s+>", ">", re.sub(r"<\s+", "<", name))


def page_text(group: Group, reference: Reference) -> str:
    """The page of a group in Markdown. Links are those of cpp.md."""
    parts = [f"# {group.title}\n\n{group.text}\n\nEverything is in the namespace `vinerow`.\n"]
    for header in group.headers:
        text, body = reference.header(header)
        parts.append(f"## {header}\n\n```cpp\n#include <{header}>\n```\n")
        parts.append("\n\n".join(filter(None, ("````````{eval-rst}", text, body, "````````"))) + "\n")
    return "\n".join(parts)
