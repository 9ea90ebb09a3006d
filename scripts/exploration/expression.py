"""Arithmetic and comparisons over dotted names, as in `timing.cycles <= 2 * run.edges_tested`."""
import ast
import operator

OPERATORS = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv, ast.Mod: operator.mod, ast.Pow: operator.pow, ast.USub: operator.neg,
    ast.Not: operator.not_, ast.Eq: operator.eq, ast.NotEq: operator.ne, ast.Lt: operator.lt, ast.LtE: operator.le,
    ast.Gt: operator.gt, ast.GtE: operator.ge}


def dotted(node):
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, ast.Attribute) and dotted(node.value):
        return f"{dotted(node.value)}.{node.attr}"
    return None


class Expression:
    def __init__(self, text):
        """Raises ValueError unless the text is an expression of names, constants and OPERATORS."""
        self.text = text
        self.names = set()
        try:
            self.root = ast.parse(text, mode="eval").body
        except SyntaxError as error:
            raise ValueError(f"`{text}` is not an expression: {error.msg}") from None
        self._check(self.root)

    def _check(self, node):
        if dotted(node):
            self.names.add(dotted(node))
            return
        operators = [getattr(node, "op", None), *getattr(node, "ops", [])]
        known = isinstance(node, (ast.Constant, ast.BoolOp)) or (
            isinstance(node, (ast.BinOp, ast.UnaryOp, ast.Compare)) and
            all(type(each) in OPERATORS for each in operators if each))
        if not known:
            raise ValueError(f"`{self.text}`: only names, constants, arithmetic, comparisons, and, or, not are allowed")
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.expr):
                self._check(child)

    def value(self, values):
        """None if a name has no value, or if it divides by zero."""
        try:
            return self._value(self.root, values)
        except (KeyError, ZeroDivisionError):
            return None

    def _value(self, node, values):
        if dotted(node):
            return values[dotted(node)]
        if isinstance(node, ast.Constant):
            return node.value
        if isinstance(node, ast.BoolOp):
            parts = (self._value(each, values) for each in node.values)
            return all(parts) if isinstance(node.op, ast.And) else any(parts)
        if isinstance(node, ast.UnaryOp):
            return OPERATORS[type(node.op)](self._value(node.operand, values))
        if isinstance(node, ast.BinOp):
            return OPERATORS[type(node.op)](self._value(node.left, values), self._value(node.right, values))
        sides = [self._value(each, values) for each in (node.left, *node.comparators)]
        return all(OPERATORS[type(op)](a, b) for op, a, b in zip(node.ops, sides, sides[1:]))
