"""A YAML file as a mapping, or one message: file, line, and what is wrong there.

YAML without what surprises: dates stay text, a key is text and stands once, and nothing is executed.
Anchors, aliases and merge keys (``<<``) work.
"""

from collections.abc import Hashable
from pathlib import Path
from typing import Any

import yaml

from upswing.study.errors import BadInput, shown

MERGE, TEXT = "tag:yaml.org,2002:merge", "tag:yaml.org,2002:str"
DATE = "tag:yaml.org,2002:timestamp"


class _Loader(yaml.SafeLoader):
    """Safe, and with a word of its own for every scalar that Python refuses."""

    # A date is text here: no key wants one, and 2001-13-45 would be an error of Python's own.
    yaml_implicit_resolvers = {  # noqa: RUF012  as PyYAML declares it
        first: [(tag, pattern) for tag, pattern in resolvers if tag != DATE]
        for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
    }

    def construct_object(self, node: yaml.Node, deep: bool = False) -> Any:
        """The value of a node; ``BadInput`` for one that cannot be made."""
        try:
            return super().construct_object(node, deep)
        except (ValueError, OverflowError, LookupError, TypeError, AttributeError) as error:
            if isinstance(error, BadInput):
                raise
            kind = node.tag.rpartition(":")[2]
            value = shown(node.value) if isinstance(node.value, str) else "what stands there"
            raise BadInput(
                [f"{self.name}: line {_line(node)}: {value}: cannot be read as {kind}"]
            ) from None

    def flatten_mapping(self, node: yaml.MappingNode) -> None:
        """Put what merge keys bring beside a mapping's own keys, which win; each key once.

        PyYAML's own keeps every copy of a key, and so nested merges would double at each level.
        """
        own = [pair for pair in node.value if pair[0].tag != MERGE]
        known = {key.value for key, _ in own}
        merged = []
        for key, value in node.value:
            if key.tag != MERGE:
                continue
            for source in value.value if isinstance(value, yaml.SequenceNode) else [value]:
                if not isinstance(source, yaml.MappingNode):
                    raise BadInput(
                        [f"{self.name}: line {_line(key)}: <<: only a mapping can be merged"]
                    )
                self.flatten_mapping(source)
                for pair in source.value:
                    if pair[0].value not in known:
                        known.add(pair[0].value)
                        merged.append(pair)
        node.value = merged + own


def read_yaml(path: Path) -> dict[str, Any]:
    """The mapping in a YAML file.

    Raises:
        BadInput: it cannot be read, is not YAML, or holds something else; or else every key that stands
            there twice or is no text, and every scalar that cannot be read.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        if isinstance(error, UnicodeDecodeError):
            raise BadInput([f"{path}: is not text in UTF-8"]) from None
        reason = error.strerror if isinstance(error, OSError) else error
        raise BadInput([f"{path}: cannot be read: {reason}"]) from None
    try:
        loader = _Loader(text)
        loader.name = str(path)
        node = loader.get_single_node()
        if node is not None:
            _check_parts(loader, node)
        content = None if node is None else loader.construct_document(node)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f" line {mark.line + 1}:" if mark else ""
        reason = getattr(error, "problem", None) or str(error).splitlines()[0]
        raise BadInput([f"{path}:{place} is not YAML: {reason}"]) from None
    except RecursionError:
        raise BadInput([f"{path}: is nested too deeply"]) from None
    if not isinstance(content, dict):
        raise BadInput([f"{path}: must hold keys and values at its top level"])
    return content


def _check_parts(loader: _Loader, root: yaml.Node) -> None:
    """Every key of every mapping is text and stands there once, and every scalar can be read."""
    name, problems = loader.name, list[tuple[int, str]]()
    waiting, seen = [root], set[int]()
    while waiting:
        node = waiting.pop()
        if id(node) in seen:
            continue
        seen.add(id(node))
        if isinstance(node, yaml.ScalarNode) and node.tag != TEXT:
            try:
                loader.construct_object(node)
            except BadInput as error:
                problems += [(_line(node), problem) for problem in error.problems]
        elif isinstance(node, yaml.SequenceNode):
            waiting.extend(node.value)
        elif isinstance(node, yaml.MappingNode):
            keys = set[Hashable]()
            for key, value in node.value:
                written = key.value if isinstance(key, yaml.ScalarNode) else f"a {key.id}"
                at = f"{name}: line {_line(key)}"
                if key.tag not in (TEXT, MERGE):
                    problems.append((_line(key), f"{at}: {shown(written)}: a key must be text"))
                elif written in keys:
                    problems.append((_line(key), f"{at}: {written}: duplicate key; keep one"))
                keys.add(written)
                waiting.append(value)
    if problems:
        raise BadInput([text for _, text in sorted(problems)])


def _line(node: yaml.Node) -> int:
    return int(node.start_mark.line) + 1
