"""Names that a deck may have: every printable character but / and \\ in one of them, and those special to some format."""

import string
import sys
import unicodedata

#: printable characters of ASCII that names may have
ASCII = "".join(character for character in string.printable if character.isprintable() and character not in "/\\")
#: the first printable character of every category and every thousandth of all, to represent the rest of Unicode
_REST = [chr(code) for code in range(0xA1, sys.maxunicode + 1) if chr(code).isprintable()]
UNICODE = "".join(dict.fromkeys([*{unicodedata.category(character): character for character in reversed(_REST)}.values(),
                                 *_REST[::1000]]))  # fmt: skip
NAMES = tuple(dict.fromkeys((
    *(f"a{ASCII[at:at + 19]}b" for at in range(0, len(ASCII), 19)), UNICODE[:150], *ASCII.replace(" ", ""),
    "=1+1", "+1", "-1", "@a", '"', "&amp;", "<b>", "]]>", "-->", "<img src=x onerror=alert(1)>", "</script>", "{body}", "{0}",
    "%s", "$x$", "a b", " a ", "Größe", "日本", "'", "''", "time", "cycle", "nan", "CON", "#", "[1]", "null",
)))  # fmt: skip
