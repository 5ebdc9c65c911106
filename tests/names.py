"""Names that a deck may have: every printable character but / and \\ in one of them, and those special to some format."""

import string
import sys
import unicodedata

#: printable characters of ASCII that names may have
ASCII = "".join(character for character in string.printable if character.isprintable() and character not in "/\\")
#: the first printable character of every category and every thousandth of all, to represent the rest of Unicode
_REST = [chr(code) for code in range(0xA1, sys.maxunicode + 1) if chr(code).isprintable()]
UNICODE = "".join(dict.fromkeys([*{unicodedata.category(character): character for character in reversed(_REST)}.values(),
                                 *_REST[::1000]]))
NAMES = tuple(dict.fromkeys((
    *(f"a{ASCII[at:at + 19]}b" for at in range(0, len(ASCII), 19)), UNICODE[:150], *ASCII.replace(" ", ""),
    "=1+1", "+1", "-1", "@a", '"', "&amp;", "<b>", "]]>", "-->", "<img src=x onerror=alert(1)>", "</script>", "{body}", "{0}",
    "%s", "$x$", "a b", " a ", "Größe", "日本", "'", "''", "time", "cycle", "nan", "CON", "#", "[1]", "null",
)))
#: characters that some format treats in its own way, wherever they stand in a name
SPECIAL = dict.fromkeys((*ASCII, *"é\u0301Ωж日한あ😀\U0001f468؟א\u0300", *UNICODE[:60]))
#: each of them at the start, in the middle and at the end of a name, and names that are devices or folders on some system
PLACED = tuple(dict.fromkeys((
    *(name for each in SPECIAL for name in (f"{each}ab", f"a{each}b", f"ab{each}")), *NAMES, "NUL", "nul.txt", "Com1", "a.",
    "a ", ".a", "-a", "~", "a/b", "/", "a\\b", "derived.P/L", "P_L", "p/l", "e\u0301", "é", "É", 200 * "x", 200 * "😀", "'=1",
    "''+1", "$(id)", "`id`", "a;b", "*", "\\$", r"$\frac{$",
)))
#: those that a body can have
OF_BODIES = tuple(name for name in PLACED if not set(name) & set("/\\") and name not in (".", "..") and name.strip())
