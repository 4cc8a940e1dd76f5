# The lists of run-time packages (`./dev packages`) against what the programs ask for, and README against the lists.
set(check ${CMAKE_CURRENT_LIST_DIR}/check)
add_test(NAME Packages.OfTheClientAreListed
         COMMAND ${check} libraries client $<TARGET_FILE:diaphane_client_shared> $<TARGET_FILE:diaphane_cli>)
add_test(NAME Packages.OfTheServerAreListed COMMAND ${check} libraries run $<TARGET_FILE:diaphane-server>)
set_tests_properties(Packages.OfTheClientAreListed Packages.OfTheServerAreListed PROPERTIES SKIP_RETURN_CODE 77 LABELS unit)
add_test(NAME Packages.AreNamedInReadme COMMAND ${check} readme)
set_tests_properties(Packages.AreNamedInReadme PROPERTIES LABELS unit)
