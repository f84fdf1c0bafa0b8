# SPDX-License-Identifier: GPL-3.0-or-later
"""Names that break programs which paste them into text, commands, paths or tables.

None holds NUL, which neither Blender nor a file system can store. CANARY is a word whose appearance
as a file means that a name was executed.
"""

import unicodedata
from collections.abc import Iterator

CANARY = "canary"
BLENDER_BYTES = 63  # of a name in Blender
FILE_BYTES = 255  # of a name in a folder

SYNTAX = (
    '"',
    "'",
    "\\",
    '\\"',
    'q"uote',
    "new\nline",
    "cr\r\nlf",
    "tab\tand\vfeed\f",
    "}}}}",
    "{{{{",
    "} sphere{<0,0,9>,9} #declare a={",
    "#",
    "##include",
    "//",
    "/*",
    "*/",
    "*/ } /*",
    "\n#end\n",
    "<b>&amp;</b>",
    "<script>alert(1)</script>",
    "<!--",
    "]]>",
    "-->",
    "&lt;&#0;",
    '{"name": null}',
    "\\u0000\\n\\x00",
    "%s%n%x%%",
    "%99999999d",
    "{0}{name!r:>{9}}",
    "${HOME}",
    "a=b;c",
    "a,b\tc|d",
    "[Section]\nkey=value",
    "; comment",
    "usemtl x\nmtllib y",
    "'; DROP TABLE levels; --",
)

COMMANDS = (
    f"$(touch {CANARY})",
    f"`touch {CANARY}`",
    f"; touch {CANARY} #",
    f"| touch {CANARY}",
    f"\ntouch {CANARY}\n",
    f'" +O{CANARY} "',
    f'\n#write("{CANARY}",1)\n',
    f'*/ #fopen F "{CANARY}" write',
    f"\nPost_Scene_Command=touch {CANARY}\n",
    f'__import__("os").mknod("{CANARY}")',
    '#include "/etc/passwd"',
    "-rf *",
    "--help",
    "-",
    "~",
    "~root",
    "*",
    "?",
    "!!",
    "@file",
    "+Iother.pov",
)

PATHS = (
    ".",
    "..",
    "...",
    "../..",
    "../../../../etc/passwd",
    "/etc/passwd",
    "//relative",
    "C:\\con",
    "con",
    "nul.txt",
    "a/b",
    "file:///etc/passwd",
    "http://example.org/a?b#c",
    ".hidden",
    "trailing.",
    "trailing ",
    " leading",
    "a.scene",
    "a.log",
    "<UDIM>",
    "####",
    "name.0001",
    "tileset.json",
    "lodestone",
)

WORDS = (
    "sphere",
    "mesh2",
    "union",
    "declare",
    "#declare",
    "texture",
    "pigment",
    "camera",
    "light_source",
    "background",
    "global_settings",
    "clock",
    "pi",
    "yes",
    "no",
    "x",
    "u",
    "version",
    "end",
    "T_Wood1",
    "LDS_R_0123456789abcdef",
    "LDS_PixelError",
    "Scene",
    "Camera",
    "Holdout",
    "hair",
    "null",
    "true",
    "NaN",
    "None",
    "0",
    "-1e999",
    "1_000",
    "",
    " ",
    "\t",
    "\n",
    "\x7f",
    "\x1b[31m\x1b]0;title\x07",
    "\x01\x02\x03\x1f",
)

UNICODE = (
    "名前",
    "é",
    "e\u0301",  # the same in another normal form
    "É",
    "ﬁ",
    "ß",
    "ẞ",
    "SS",
    "İi",
    "ıI",
    "Å",
    "\u212b",  # Angstrom
    "א\u05b8ב",
    "مرحبا",
    "\u202egnp.exe",
    "\u2066a\u2069",
    "a\u200bb",
    "a\u200db",
    "\ufeffbom",
    "a\ufeff",
    "line\u2028separator",
    "paragraph\u2029separator",
    "next\u0085line",
    "no\u00a0break",
    "\u3000wide",
    "\ufffd",
    "\ufffe\uffff",
    "\U0010ffff",
    "\ue000",
    "👩\u200d👩\u200d👧",
    "🇩🇪",
    "z" + "\u0301" * 25,
    "ｓｐｈｅｒｅ",
    "⁄etc⁄passwd",
    "＂",
    "𝓍",
    "\ud7ff\ue000",  # on both sides of the surrogates
)

# Bytes that are no UTF-8, for what may hold bytes: Latin-1, cut and overlong characters, surrogates
BYTES = (
    b"caf\xe9",
    b"\xff\xfe",
    b"\xc3(",
    b"cut\xe5\x90",
    b"\xc0\xafetc",
    b"\xed\xa0\x80",
    b"\xf4\x90\x80\x80",
    b"\x80",
)


PRIVATE = (range(0xE010, 0xF900), range(0xF0010, 0x100000), range(0x100010, 0x110000))


def columns() -> Iterator[str]:
    """A character of every Unicode block: these begin at multiples of 16; the large ones of one
    script are only looked into here and there."""
    for start in range(0x80, 0x110000, 16):
        large = 0x3400 <= start < 0xA000 or 0xAC00 <= start < 0xD7A0 or start >= 0x20000
        if large and start % 64 or any(start in area for area in PRIVATE):
            continue
        for code in range(start, start + 16):
            if unicodedata.category(chr(code)) not in ("Cn", "Cs"):
                yield chr(code)
                break


def cut(text: str, most: int) -> str:
    """Its beginning of at most that many bytes."""
    return text.encode()[:most].decode("utf-8", "ignore")


def full(text: str, most: int) -> str:
    """Repeated until no more of it fits."""
    return cut(text * (most // max(1, len(text.encode())) + 1), most)


def packed(characters: Iterator[str], most: int) -> Iterator[str]:
    """Joined to names as long as may be."""
    name = ""
    for character in characters:
        if len((name + character).encode()) > most:
            yield name
            name = ""
        name += character
    if name:
        yield name


def names(most: int = BLENDER_BYTES) -> list[str]:
    """The whole corpus, each of at most that many bytes, in a fixed order, each once."""
    found = [*SYNTAX, *COMMANDS, *PATHS, *WORDS, *UNICODE]
    found += [full(text, most) for text in ("a", "ab", "é", "x" + "é", "名", "x名", "🐸", "xyz🐸", '"')]
    found += [full("a", most - 1) + "A", full("a", most - 1) + "B", "Case", "case", "CASE"]
    found += packed(columns(), most)
    return list(dict.fromkeys(cut(name, most) for name in found))


def file_stems(ending: str = "") -> list[str]:
    """Those that can name a file with that ending."""
    most = FILE_BYTES - len(ending.encode())
    kept = [name for name in names(most) if name and "/" not in name]
    return [name for name in kept if name + ending not in (".", "..")]
