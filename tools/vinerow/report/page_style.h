#pragma once
/// How the report looks, on screens light and dark and on paper, and the little that it does by
/// itself: a read-out under the pointer, pictures that grow when they are clicked.

namespace vinerow::tools::report {

/// Content of <style>.
const char* page_style();

/// Content of <script>; no "<" or "&" in it, so that it is well formed as XML, too.
const char* page_script();

}  // namespace vinerow::tools::report
