# Installs the project below the build folder and builds somebody else's program against it.
set(consumer ${CMAKE_BINARY_DIR}/consumer)
add_test(NAME Install.LeavesAPrefix
         COMMAND sh -c "rm -rf ${consumer}/prefix && cmake --install ${CMAKE_BINARY_DIR} --prefix ${consumer}/prefix")
set_tests_properties(Install.LeavesAPrefix PROPERTIES FIXTURES_SETUP prefix LABELS e2e)
foreach(way cmake pkg-config)
  add_test(NAME Consumer.BuildsAndRendersBy.${way}
           COMMAND ${CMAKE_CURRENT_LIST_DIR}/check ${way} ${consumer}/prefix ${consumer}/${way})
  set_tests_properties(Consumer.BuildsAndRendersBy.${way} PROPERTIES FIXTURES_REQUIRED prefix LABELS e2e TIMEOUT 300)
endforeach()
