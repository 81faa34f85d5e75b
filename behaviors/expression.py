"""Conditions over ports: `left > 0 and plan.outcome == "goal_reached"`.

A condition compares keys, fields of what they hold, numbers and texts, with `and`, `or`, `not`, `+ - *` and
parentheses, as Python does. It is parsed by Python's own parser, but what is not listed here is refused; nothing is
called and nothing is looked up but fields, so a tree file cannot run code. All types are known before it runs.
"""

from __future__ import annotations

import ast
import dataclasses
import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum
from functools import lru_cache
from typing import Any, get_type_hints

from behaviors.blackboard import type_name
from strict_yaml import nearest

MAXIMUM_LENGTH = 500

Evaluate = Callable[[Mapping[str, Any]], Any]

_COMPARISONS: dict[type[ast.cmpop], Callable[[Any, Any], bool]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
}
_ARITHMETIC: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
}
_ALLOWED = "keys, their fields, numbers, texts, true, false, and, or, not, == != < <= > >=, + - * and parentheses"
_SYNTAX = (
    *(ast.Constant, ast.Name, ast.Load, ast.Attribute, ast.BoolOp, ast.And, ast.Or, ast.UnaryOp, ast.Not, ast.USub),
    *(ast.BinOp, *_ARITHMETIC, ast.Compare, *_COMPARISONS),
)
_CONSTANTS = {"true": True, "false": False}


class ExpressionError(ValueError):
    """A condition that cannot be used.

    Attributes:
        message: what is wrong, and what is allowed.
        offset: index of the character at which it is.
    """

    def __init__(self, message: str, offset: int) -> None:
        super().__init__(message)
        self.message = message
        self.offset = offset


@dataclass(frozen=True, slots=True)
class Expression:
    """A condition that has been parsed, whose types have not been checked.

    Attributes:
        text: as it was written.
        names: the keys that it reads, in the order in which they are written, and the offset of each.
    """

    text: str
    names: tuple[tuple[str, int], ...]
    _body: ast.expr

    def compile(self, types: Mapping[str, Any]) -> Evaluate:
        """What gives the truth for values by key, none of which is None.

        Args:
            types: declared type of every key in `names`.

        Raises:
            ExpressionError: where the types do not fit.
        """
        evaluate, given = _Compiler(types).compile(self._body)
        if given is not bool:
            raise ExpressionError(f"a condition is true or false, this is {type_name(given)}", 0)
        return evaluate


@lru_cache(maxsize=256)
def parse_expression(text: str) -> Expression:
    """Parse a condition.

    Raises:
        ExpressionError: where it is none.
    """
    if len(text) > MAXIMUM_LENGTH:
        raise ExpressionError(f"a condition has at most {MAXIMUM_LENGTH} characters, got {len(text)}", 0)
    if "\n" in text.strip() or not text.strip():
        raise ExpressionError("needs a condition on one line, such as left > 0", 0)
    try:
        body = ast.parse(text.strip(), mode="eval").body
    except SyntaxError as error:
        raise ExpressionError(f"not a condition: {error.msg}", max(0, (error.offset or 1) - 1)) from error
    except (ValueError, RecursionError, MemoryError) as error:
        raise ExpressionError(f"not a condition: {error}", 0) from error
    names: dict[str, int] = {}
    for node in ast.walk(body):
        if not isinstance(node, _SYNTAX):
            raise ExpressionError(f"not allowed here; a condition has {_ALLOWED}", getattr(node, "col_offset", 0))
        if isinstance(node, ast.Name) and node.id not in _CONSTANTS:
            names[node.id] = min(node.col_offset, names.get(node.id, node.col_offset))
    return Expression(text, tuple(sorted(names.items(), key=lambda name: name[1])), body)


class _Compiler:
    """Gives for each part what evaluates it, and the type of what that gives."""

    def __init__(self, types: Mapping[str, Any]) -> None:
        self.types = types

    def compile(self, node: ast.expr) -> tuple[Evaluate, Any]:
        match node:
            case ast.Constant(value=bool() | int() | float() | str() as value):
                return (lambda _: value), type(value)
            case ast.Name(id=name):
                return self._name(name)
            case ast.Attribute():
                return self._field(node)
            case ast.BoolOp():
                return self._logic(node)
            case ast.UnaryOp(op=ast.Not()):
                inner = self._typed(node.operand, bool)
                return (lambda values: not inner(values)), bool
            case ast.UnaryOp(op=ast.USub()):
                inner, given = self._number(node.operand)
                return (lambda values: -inner(values)), given
            case ast.BinOp() if type(node.op) in _ARITHMETIC:
                return self._arithmetic(node)
            case ast.Compare() if all(type(op) in _COMPARISONS for op in node.ops):
                return self._comparison(node)
        raise ExpressionError(f"not allowed here; a condition has {_ALLOWED}", node.col_offset)

    def _name(self, name: str) -> tuple[Evaluate, Any]:
        if name in _CONSTANTS:
            value = _CONSTANTS[name]
            return (lambda _: value), bool
        return (lambda values: values[name]), self.types[name]

    def _field(self, node: ast.Attribute) -> tuple[Evaluate, Any]:
        inner, owner = self.compile(node.value)
        fields = fields_of(owner)
        offset = (node.end_col_offset or node.col_offset) - len(node.attr)
        if node.attr not in fields:
            allowed = ", ".join(sorted(fields)) or "none"
            message = f'{type_name(owner)} has no field "{node.attr}"{nearest(node.attr, fields)} (fields: {allowed})'
            raise ExpressionError(message, offset)
        read = operator.attrgetter(node.attr)
        return (lambda values: read(inner(values))), fields[node.attr]

    def _logic(self, node: ast.BoolOp) -> tuple[Evaluate, Any]:
        parts = [self._typed(value, bool) for value in node.values]
        decide = all if isinstance(node.op, ast.And) else any
        return (lambda values: decide(part(values) for part in parts)), bool

    def _arithmetic(self, node: ast.BinOp) -> tuple[Evaluate, Any]:
        (left, left_type), (right, right_type) = self._number(node.left), self._number(node.right)
        operate = _ARITHMETIC[type(node.op)]
        is_whole = left_type is int and right_type is int
        return (lambda values: operate(left(values), right(values))), int if is_whole else float

    def _comparison(self, node: ast.Compare) -> tuple[Evaluate, Any]:
        operands = [node.left, *node.comparators]
        parts = [self.compile(operand) for operand in operands]
        tests = []
        for index, op in enumerate(node.ops):
            pair = operands[index : index + 2]
            tests.append(self._test(op, pair, parts[index : index + 2]))
        return (lambda values: all(test(values) for test in tests)), bool

    def _test(self, op: ast.cmpop, operands: list[ast.expr], parts: list[tuple[Evaluate, Any]]) -> Evaluate:
        (left, left_type), (right, right_type) = parts
        compare = _COMPARISONS[type(op)]
        is_equality = isinstance(op, ast.Eq | ast.NotEq)
        for enum, other, written in ((left_type, right_type, operands[1]), (right_type, left_type, operands[0])):
            if _is_enum(enum) and is_equality and isinstance(written, ast.Constant) and other is str:
                _check_member(enum, written)
                return lambda values: compare(_plain(left(values)), _plain(right(values)))
        both_numbers = _is_number(left_type) and _is_number(right_type)
        both_texts = left_type is str and right_type is str
        same = left_type is right_type and (left_type is bool or _is_enum(left_type))
        if not (both_numbers or both_texts or (same and is_equality)):
            message = f"cannot compare {type_name(left_type)} with {type_name(right_type)}"
            raise ExpressionError(message, operands[1].col_offset)
        return lambda values: compare(left(values), right(values))

    def _typed(self, node: ast.expr, needed: type) -> Evaluate:
        evaluate, given = self.compile(node)
        if given is not needed:
            raise ExpressionError(f"needs {type_name(needed)}, this is {type_name(given)}", node.col_offset)
        return evaluate

    def _number(self, node: ast.expr) -> tuple[Evaluate, Any]:
        evaluate, given = self.compile(node)
        if not _is_number(given):
            raise ExpressionError(f"needs a number, this is {type_name(given)}", node.col_offset)
        return evaluate, given


@lru_cache(maxsize=256)
def fields_of(cls: Any) -> Mapping[str, Any]:
    """Types of the fields and properties of a class that a condition may read, by name."""
    if not isinstance(cls, type) or cls in (bool, int, float, str):
        return {}
    fields: dict[str, Any] = {}
    if dataclasses.is_dataclass(cls):
        hints = get_type_hints(cls)
        fields = {field.name: hints[field.name] for field in dataclasses.fields(cls)}
    for base in reversed(cls.__mro__):
        for name, value in vars(base).items():
            if isinstance(value, property) and value.fget is not None and not name.startswith("_"):
                fields[name] = get_type_hints(value.fget).get("return", Any)
    return {name: declared for name, declared in fields.items() if not name.startswith("_")}


def _is_enum(declared: Any) -> bool:
    return isinstance(declared, type) and issubclass(declared, Enum)


def _is_number(declared: Any) -> bool:
    return declared is int or declared is float


def _check_member(enum: type[Enum], written: ast.Constant) -> None:
    allowed = [str(member.value) for member in enum]
    if written.value not in allowed:
        message = f'{enum.__name__} is never "{written.value}"{nearest(str(written.value), allowed)}'
        raise ExpressionError(f"{message} (allowed: {', '.join(allowed)})", written.col_offset)


def _plain(value: Any) -> Any:
    return value.value if isinstance(value, Enum) else value
