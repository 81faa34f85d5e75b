"""Trees in other forms: YAML in one canonical layout with its comments, BehaviorTree.CPP's XML, and Groot2's logs."""

from behaviors.interchange.groot_log import write_groot_log
from behaviors.interchange.read_tree import read_written
from behaviors.interchange.tree_yaml import write_yaml
from behaviors.interchange.written import WrittenFile, WrittenNode, WrittenPort, WrittenTree
from behaviors.interchange.xml_palette import write_palette
from behaviors.interchange.xml_reader import read_xml
from behaviors.interchange.xml_writer import write_xml

__all__ = [
    "WrittenFile",
    "WrittenNode",
    "WrittenPort",
    "WrittenTree",
    "read_written",
    "read_xml",
    "write_groot_log",
    "write_palette",
    "write_xml",
    "write_yaml",
]
