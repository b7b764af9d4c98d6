#pragma once
/// Forward declaration of ParameterTable, for headers that declare a table and define its rows in a
/// source file.

namespace vinerow {

template <class P>
class ParameterTable;

}  // namespace vinerow
