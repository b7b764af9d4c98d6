#pragma once
/// What the plots of a study do on a page.

namespace vinerow::study {

/// Content of <script> at the end of the body; no "<" or "&" in it, so that it is well formed as
/// XML, too. On a click, or Enter, on a mark with `data-cell="5"`, a panel at the bottom shows the
/// cell's command with a button that copies it: the attribute `data-command` of an element around
/// the mark, a space and the number. Tab goes from plot to plot, arrows from mark to mark, Escape
/// closes the panel.
const char* click_script();

}  // namespace vinerow::study
