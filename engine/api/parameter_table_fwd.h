#pragma once
/// For headers that declare the table of a struct and leave its rows to their source file.

namespace vinerow {

template <class P>
class ParameterTable;

}  // namespace vinerow
