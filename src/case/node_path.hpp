#pragma once
#include <string>
#include <vector>

#include "case/node.hpp"

/// Ways through the tree by dotted names such as "grid.x" or "body.0.velocity".
namespace ejecta {

std::vector<std::string> split_path(const std::string& path);

/// The node of a section, or nothing: tables only, no list elements.
const Node* find_section(const Node& root, const std::string& name);

/// The element of a list by number or by its `name`, or nothing.
const Node* element(const Node& list, const std::string& which);

/// What stands at a path through tables and lists, or nothing.
const Node* find_node(const Node& root, const std::string& path);

/// Where a key stands: the place of the deepest part of the path that the tree has.
Place locate(const Node& root, const std::string& path);

}  // namespace ejecta
