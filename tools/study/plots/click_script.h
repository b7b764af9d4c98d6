#pragma once
/// Script for the plots on a study's page.

namespace vinerow::study {

/// Content of <script> at the end of the body, without "<" and "&", so that it is well-formed XML
/// too. A click or Enter on a mark with `data-cell="5"` opens a panel at the bottom with the cell's
/// command and a button that copies it. The command is the attribute `data-command` of an enclosing
/// element, a space and the number. Tab moves from plot to plot, arrow keys from mark to mark,
/// Escape closes the panel.
const char* click_script();

}  // namespace vinerow::study
