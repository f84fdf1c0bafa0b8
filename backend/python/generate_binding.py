# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the Python package lodestone_native in the build folder: what is written by hand, and from
the C header enums.py (its numbers), structs.py, records.py (the values of structs that calls fill)
and functions.py, with types for mypy in .pyi files (of the package's own names, too) and the
header's comments.

    generate_binding.py --header lodestone.h --package lodestone_native --out build/NAME/python/...
"""

from __future__ import annotations

import argparse
import re
import runpy
import sys
import textwrap
from pathlib import Path

from c_header import NUMBERS, Header, HeaderError, Type, Variable, read

WIDTH = 100
HEAD = '# SPDX-License-Identifier: GPL-3.0-or-later\n# Generated from {}.\n"""{}"""\n\n{}'
SIZE = "struct_size"  # the first field of structs that may grow


def class_name(name: str) -> str:
    return "".join(word.capitalize() for word in name.removeprefix("lds_").split("_"))


def commented(line: str, doc: str, indent: str = "    ") -> str:
    """A line with its comment behind it, or before it where that is too long."""
    text = " ".join(doc.split())
    if not text or len(f"{indent}{line}  # {text}") <= WIDTH:
        return f"{indent}{line}  # {text}\n" if text else f"{indent}{line}\n"
    wrapped = textwrap.wrap(text, WIDTH - len(indent) - 2)
    return "".join(f"{indent}# {part}\n" for part in wrapped) + f"{indent}{line}\n"


def docstring(doc: str, indent: str = "    ") -> str:
    text = doc.replace("\\", "\\\\").replace('"', '\\"')
    return textwrap.indent(f'"""{text}"""\n\n', indent) if doc else ""


def imported(module: str, names: str, text: str) -> str:
    """The import of those names of a module that a text uses."""
    used = sorted(set(re.findall(rf"\b(?:{names})\b", text)) - {""})
    return f"from {module} import (\n    {', '.join(used)},\n)\n" if used else ""


def enums_text(header: Header) -> str:
    out = HEAD.format(header.name, "Numbers of the C interface.", "from enum import IntEnum\n\n")
    for name, (value, doc) in header.constants.items():
        out += commented(f"{name.removeprefix('LDS_')} = {value}", doc, "")
    for name, (doc, listed) in header.enums.items():
        out += f"\n\nclass {class_name(name)}(IntEnum):\n{docstring(doc)}"
        # Members begin with words of the enum's name; a status is none or an error.
        starts = [name.upper()[:i] + "_" for i in range(len(name), 4, -1)] + ["LDS_ERROR_"]
        start = next(
            s for s in starts if s == starts[-1] or all(m[0].startswith(s) for m in listed)
        )
        for word, value, said in listed:
            short = word.removeprefix(start).removeprefix("LDS_")
            out += commented(f"{short} = {value}", said)
    return out


class Types:
    """How the types of C are spelled in Python."""

    def __init__(self, header: Header) -> None:
        self.header = header

    def pointer(self, t: Type) -> bool:
        """Whether ctypes sees a pointer; texts and handles are values."""
        return t.stars > (t.base in ("char", "void", *self.header.opaque))

    def item(self, t: Type) -> str:
        """The ctypes name of a value, or of what a pointer points to."""
        if t.base in NUMBERS:
            return "c_" + (t.base if t.base == "size_t" else t.base.removesuffix("_t"))
        if t.base == "char":
            return "c_char_p"
        if t.base == "void" or t.base in self.header.opaque:
            return "c_void_p"
        return "c_int32" if t.base in self.header.enums else class_name(t.base)

    def ctypes(self, t: Type, argument: bool = False) -> str:
        if t.size is not None and not argument:
            return f"{self.item(t)} * {t.size}"
        pointer = self.pointer(t) or t.size is not None
        return f"POINTER({self.item(t)})" if pointer else self.item(t)

    def value(self, t: Type) -> str:
        item = self.item(t)
        if t.base in (*NUMBERS, *self.header.enums):
            return "float" if t.base in ("float", "double") else "int"
        return {"c_char_p": "Text", "c_void_p": "int | None"}.get(item, item)

    def field(self, t: Type) -> str:
        kind = "Array" if t.size is not None else "Pointer" if self.pointer(t) else ""
        return f"{kind}[{self.item(t)}]" if kind else self.value(t)

    def given(self, t: Type) -> str:
        """What may be assigned to a field."""
        if t.size is not None:
            return f"Array[{self.item(t)}] | tuple[{self.value(t)}, ...]"
        if self.pointer(t):
            return f"Pointer[{self.item(t)}] | Array[{self.item(t)}] | None"
        return "c_void_p | int | None" if self.item(t) == "c_void_p" else self.value(t)

    def argument(self, t: Type) -> str:
        if self.pointer(t) or t.size is not None:
            return f"Ref[{self.item(t)}]"
        return "c_void_p" if self.item(t) == "c_void_p" else self.value(t)

    def recorded(self, variable: Variable) -> str:
        value = self.value(variable.type).replace("Text", "str")
        if self.pointer(variable.type):
            raise HeaderError(f"{self.header.name}: {variable.name}: a record holds no pointer")
        return value if variable.type.size is None else f"tuple[{value}, ...]"


def ordered(header: Header) -> list[str]:
    """The structs, each after those that it holds or points to."""
    found: list[str] = []

    def take(name: str, inside: list[str]) -> None:
        if name in inside:
            raise HeaderError(f"{header.name}: {name} holds or points to itself")
        if name not in found:
            for one in header.structs[name][1]:
                if one.type.base in header.structs:
                    take(one.type.base, [*inside, name])
            found.append(name)

    for name in header.structs:
        take(name, [])
    return found


def recorded(header: Header) -> list[str]:
    """The structs that grow and that some call fills."""
    out = {a.type.base for f in header.functions for a in f.arguments if a.name.startswith("out_")}
    return [n for n, (_, fields) in header.structs.items() if n in out and fields[0].name == SIZE]


def structs_texts(header: Header) -> tuple[str, str]:
    """The module and its types."""
    types, out, stub = Types(header), "", ""
    for name in ordered(header):
        doc, fields = header.structs[name]
        sized, made = fields[0].name == SIZE, f"records.{class_name(name)}"
        identifies = [f.name for f in fields] == ["index", "generation"]
        base = "Sized" if sized else "Id" if identifies else "Structure"
        out += f"\n\nclass {class_name(name)}({base}):\n{docstring(doc)}    _fields_ = [\n"
        stub += f"\nclass {class_name(name)}({base}):\n"
        given = ["self"] if identifies else ["self", "*"]
        for one in fields:
            out += commented(f'("{one.name}", {types.ctypes(one.type)}),', one.doc, " " * 8)
            stub += f"    {one.name}: {types.field(one.type)}\n"
            given += [f"{one.name}: {types.given(one.type)} = ..."] if one.name != SIZE else []
        out += "    ]\n"
        stub += (
            f"    def __init__({', '.join(given if len(given) > 2 else given[:1])}) -> None: ...\n"
        )
        if name in recorded(header):
            out += f"\n    def record(self) -> {made}:\n        return {made}(**plain(self))\n"
            stub += f"    def record(self) -> {made}: ...\n"
    texts = []
    for text, base in ((out, "Id|Sized|plain"), (stub, "Id|Pointer|Sized|Text")):
        uses = imported("ctypes", r"c_\w+|POINTER|Array|Structure", text)
        uses += f"from . import records\n{imported('.base', base, text)}"
        texts.append(HEAD.format(header.name, "Structs of the C interface.", uses) + text)
    return texts[0], texts[1]


def records_text(header: Header) -> str:
    types, out = Types(header), ""
    for name in recorded(header):
        doc, fields = header.structs[name]
        out += f"\n\nclass {class_name(name)}(NamedTuple):\n{docstring(doc)}"
        for one in fields[1:]:
            out += commented(f"{one.name}: {types.recorded(one)}", one.doc)
    uses = "from __future__ import annotations\n\nfrom typing import TYPE_CHECKING, NamedTuple\n"
    uses += "\nif TYPE_CHECKING:\n    from . import structs\n"
    names = "|".join(map(class_name, header.structs))
    out = re.sub(rf"(: )({names})\b(?=  #|$)", r"\1structs.\2", out, flags=re.MULTILINE)
    return HEAD.format(header.name, "Values of structs that calls fill.", uses) + out


def functions_texts(header: Header) -> tuple[str, str]:
    """The module and its types."""
    types = Types(header)
    out = "\n# Name, type of the result, types of the arguments.\nPROTOTYPES = (\n"
    stub = "\nPROTOTYPES: tuple[tuple[str, Any, list[Any]], ...]\n\nclass Functions(CDLL):\n"
    for one in header.functions:
        nothing = one.result == Type("void")
        given = ", ".join(types.ctypes(a.type, argument=True) for a in one.arguments)
        result = "None" if nothing else types.ctypes(one.result)
        out += f'    ("{one.name}", {result}, [{given}]),\n'
        named = ["self"] + [f"{a.name}: {types.argument(a.type)}" for a in one.arguments]
        result = "None" if nothing else types.value(one.result)
        stub += f"    def {one.name}({', '.join(named)}) -> {result}:\n"
        stub += docstring(one.doc, " " * 8).rstrip() + "\n" if one.doc else "        ...\n"
    out += ')\n\n\nclass Functions(CDLL):\n    """The library; functions.pyi has its types."""\n'
    names, texts = "|".join(map(class_name, header.structs)), []
    for text, typing in ((out, ""), (stub, "from typing import Any\n\n")):
        uses = imported("ctypes", r"c_\w+|CDLL|POINTER", text) + imported(".base", "Ref|Text", text)
        uses = typing + uses + imported(".structs", names, text)
        texts.append(HEAD.format(header.name, "Functions of the C interface.", uses) + text)
    return texts[0], texts[1]


def package(header: Header) -> dict[str, str]:
    """The files that are made. Throws HeaderError."""
    made = {"enums.py": enums_text(header), "records.py": records_text(header)}
    made["structs.py"], made["structs.pyi"] = structs_texts(header)
    made["functions.py"], made["functions.pyi"] = functions_texts(header)
    return made


def names_stub(names: dict[str, str]) -> str:
    """The types of a package whose names are loaded when they are used. `names`: those of each
    module; "": the module itself is one."""
    out = ""
    for module, text in names.items():
        out += "".join(f"from .{module} import {one} as {one}\n" for one in text.split())
        out += "" if text else f"from . import {module} as {module}\n"
    return HEAD.format("__init__.py", "The names of the package.", out)


def main() -> int:
    parser = argparse.ArgumentParser(description="Makes the Python package of a C header.")
    parser.add_argument("--header", type=Path, required=True)
    parser.add_argument("--package", type=Path, required=True, help="what is written by hand")
    parser.add_argument("--out", type=Path, required=True, help="the whole package")
    options = parser.parse_args()
    try:
        made = package(read(options.header.name, options.header.read_text(encoding="utf-8")))
    except HeaderError as error:
        print(f"generate_binding: {error}", file=sys.stderr)
        return 1
    for source in sorted(options.package.iterdir()):
        if source.name == "py.typed" or source.suffix == ".py":
            made[source.name] = source.read_text(encoding="utf-8")
    names = runpy.run_path(str(options.package / "__init__.py")).get("NAMES", {})
    made["__init__.pyi"] = names_stub(names)
    options.out.mkdir(parents=True, exist_ok=True)
    for old in options.out.iterdir():
        if old.is_file() and old.name not in made:
            old.unlink()
    for name, text in made.items():
        target = options.out / name
        if not target.is_file() or target.read_text(encoding="utf-8") != text:
            target.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
