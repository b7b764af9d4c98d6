#pragma once
/// Style and script of the report: light, dark and print styles, a read-out under the pointer,
/// pictures that open over the page.

#include <string>

namespace vinerow::tools::report {

/// Content of <style>, with the vehicles' colours of engine/playback/vehicle_colours.h.
std::string page_style();

/// Content of <script>, without "<" and "&", so that it is well-formed XML too.
const char* page_script();

/// Dialog that shows a picture large; empty until the script fills it.
const char* picture_dialog();

}  // namespace vinerow::tools::report
