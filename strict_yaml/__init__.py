"""The one reader of all our YAML: every error says file:line:column, what it got and what is allowed."""

from strict_yaml.document import load_document, parse_document
from strict_yaml.locator import shipped, shipped_folder
from strict_yaml.node import Entry, Kind, Node, Scalar
from strict_yaml.problem import Location, Problem, YamlError, nearest
from strict_yaml.typed import read_dataclass
from strict_yaml.writer import dump_parameters

__all__ = [
    "Entry",
    "Kind",
    "Location",
    "Node",
    "Problem",
    "Scalar",
    "YamlError",
    "dump_parameters",
    "load_document",
    "nearest",
    "parse_document",
    "read_dataclass",
    "shipped",
    "shipped_folder",
]
