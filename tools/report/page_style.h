#pragma once
/// How the report looks, on screens light and dark and on paper, and the little that it does by
/// itself: a read-out under the pointer, pictures that open over the page.

#include <string>

namespace vinerow::tools::report {

/// Content of <style>, with the vehicles' colours of engine/playback/vehicle_colours.h.
std::string page_style();

/// Content of <script>; no "<" or "&" in it, so that it is well formed as XML, too.
const char* page_script();

/// What shows a picture large: empty until the script fills it.
const char* picture_dialog();

}  // namespace vinerow::tools::report
