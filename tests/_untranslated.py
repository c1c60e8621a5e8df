"""Texts of operators that translators would not find, or that are put together before they are translated.

Blender itself extracts labels, descriptions, names of properties and of enumerations from what is registered,
and literals given to its layouts. All other texts go through `shell/messages`, or are a `core.text.Sentence`.
"""

import ast
import re
from collections.abc import Iterable, Iterator

from _sentences import ERRORS, STAGES, name_of

WORDS = re.compile(r"[a-z]{2,}[,;:.]? +[('{]*[A-Za-z]{2,}|^[A-Z][a-z]+ |^[A-Z][a-z]{2,}$")
"""What reads like words: two of them, or one with a capital."""
TRANSLATED = frozenset(
    {"label", "tooltip", "count_label", "say", "warn", "translated", "Sentence", "pgettext_n"}
)
"""Functions of Keymark's that translate their literals, or keep them as templates until they are shown."""
DRAWN = frozenset({"text", "heading", "placeholder", "title", "message", "confirm_text"})
"""Arguments of Blender's layouts and dialogs, whose literals it extracts and translates."""
REGISTERED = frozenset({"bl_label", "bl_description", "bl_category", "bl_options", "bl_parent_id"})
"""Attributes of registered classes."""


def texts(node: ast.AST) -> Iterator[ast.Constant | ast.JoinedStr]:
    """Literals and f-strings below a node, those within f-strings left out."""
    if isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Constant) and isinstance(node.value, str)):
        yield node
        return
    for child in ast.iter_child_nodes(node):
        yield from texts(child)


def words_of(text: ast.Constant | ast.JoinedStr) -> str:
    """What a text says, with {} for its values."""
    if isinstance(text, ast.Constant):
        return str(text.value)
    parts = [part.value if isinstance(part, ast.Constant) else "{}" for part in text.values]
    return "".join(map(str, parts))


def translated_names(trees: Iterable[ast.Module]) -> set[str]:
    """Names of constants that are given to what translates: templates, and items of enumerations."""
    names = (
        part.id if isinstance(part, ast.Name) else part.attr
        for tree in trees
        for call in ast.walk(tree)
        if isinstance(call, ast.Call) and _translates(call)
        for argument in (*call.args, *(keyword.value for keyword in call.keywords))
        for part in ast.walk(argument)
        if isinstance(part, ast.Name | ast.Attribute)
    )
    return {name for name in names if name.isupper()}  # a variable may be another one elsewhere


def untranslated(tree: ast.Module, known: set[str]) -> Iterator[tuple[int, str]]:
    """Line and words of each text that is not translated, or is put together beforehand.

    Args:
        tree: A module.
        known: What `translated_names` gives of all modules.
    """
    fine = set(_documentation(tree))
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            fine |= set(_in_call(node))
        elif isinstance(node, ast.Assign | ast.AnnAssign) and node.value is not None:
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            if {part.id for target in targets for part in ast.walk(target) if isinstance(part, ast.Name)} & (
                known | REGISTERED
            ):
                fine |= set(_literals(node.value))
        elif isinstance(node, ast.Compare | ast.Subscript | ast.Dict):
            keys = node.keys if isinstance(node, ast.Dict) else [node]
            fine |= {text for key in keys if key is not None for text in _literals(key)}
    yield from _put_together(tree)
    for text in texts(tree):
        if text not in fine and WORDS.search(words_of(text)):
            yield text.lineno, words_of(text)


def _literals(node: ast.AST) -> list[ast.Constant | ast.JoinedStr]:
    return [text for text in texts(node) if isinstance(text, ast.Constant)]


def _translates(call: ast.Call) -> bool:
    name = name_of(call)
    if isinstance(call.func, ast.Name) and name in TRANSLATED | STAGES | ERRORS:
        return True  # a layout's method `label` is another one
    return name.endswith("Property")


def _in_call(call: ast.Call) -> list[ast.Constant | ast.JoinedStr]:
    """The texts of a call that are translated."""
    if _translates(call):
        return [text for part in (*call.args, *call.keywords) for text in _literals(part)]
    if any(keyword.arg == "translate" for keyword in call.keywords):
        return []
    drawn = [keyword.value for keyword in call.keywords if keyword.arg in DRAWN]
    return [text for part in drawn for text in _literals(part)]


def _put_together(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Templates that are added up, of which translators find the parts."""
    for call in ast.walk(tree):
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and name_of(call) in TRANSLATED:
            for part in (part for argument in call.args for part in ast.walk(argument)):
                if isinstance(part, ast.BinOp) and (_literals(part.left) or _literals(part.right)):
                    yield part.lineno, ast.unparse(part)


def _documentation(tree: ast.Module) -> Iterator[ast.Constant | ast.JoinedStr]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            yield node.value
        if isinstance(node, ast.FunctionDef):
            for annotation in (node.returns, *(each.annotation for each in node.args.args)):
                yield from _literals(annotation) if annotation is not None else ()
        if isinstance(node, ast.AnnAssign):
            yield from _literals(node.annotation)
