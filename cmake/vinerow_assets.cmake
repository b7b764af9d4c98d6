# Files that become part of a program when it is built, so that its pages need neither an installation nor a network.
enable_language(ASM)

# vinerow_embed(TARGET NAME=FILE...): the library TARGET has the symbols vinerow_asset_NAME and vinerow_asset_NAME_end, start
# and end of the file (tools/replay/embedded_file.h). An assembler reads the files as they are; a compiler would take minutes
# for their bytes as numbers.
function(vinerow_embed target)
  set(assembly ".section .rodata\n")
  set(files)
  foreach(entry ${ARGN})
    string(REPLACE "=" ";" pair ${entry})
    list(GET pair 0 name)
    list(GET pair 1 file)
    get_filename_component(file ${file} ABSOLUTE)
    string(APPEND assembly ".global vinerow_asset_${name}\nvinerow_asset_${name}:\n.incbin \"${file}\"\n")
    string(APPEND assembly ".global vinerow_asset_${name}_end\nvinerow_asset_${name}_end:\n.byte 0\n")
    list(APPEND files ${file})
  endforeach()
  string(APPEND assembly ".section .note.GNU-stack,\"\",@progbits\n")
  # In lower case: a file that ends on .S would go through the C preprocessor first.
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${target}_assets.s)
  file(CONFIGURE OUTPUT ${source} CONTENT "${assembly}" @ONLY)
  # Clang warns of options of C++ that an assembler has no use for.
  set_source_files_properties(${source} PROPERTIES OBJECT_DEPENDS "${files}" COMPILE_OPTIONS -Wno-unused-command-line-argument)
  target_sources(${target} PRIVATE ${source})
endfunction()
