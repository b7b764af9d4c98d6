# What a wheel has besides the Python files, all in the package's folder: the extension module, the library, the command, assets.
set_target_properties(vinerow_python PROPERTIES INSTALL_RPATH "$ORIGIN")
set_target_properties(vinerow_command PROPERTIES INSTALL_RPATH "$ORIGIN/..")
install(TARGETS vinerow vinerow_python LIBRARY DESTINATION vinerow COMPONENT wheel NAMELINK_SKIP)
install(TARGETS vinerow_command RUNTIME DESTINATION vinerow/bin COMPONENT wheel)
install(DIRECTORY assets DESTINATION vinerow/share/vinerow COMPONENT wheel)
# Parts written in Python, for the command.
foreach(opened_later vinerow_python_host vinerow_net_host)
  if(TARGET ${opened_later})
    install(TARGETS ${opened_later} LIBRARY DESTINATION vinerow COMPONENT wheel OPTIONAL)
  endif()
endforeach()
