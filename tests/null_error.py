# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints of the headers that it is given a header by which a program calls every function
that takes a tm_error with NULL in its place; in the program's own error is the status
then. Fails where there is none, or it is not the last parameter."""
import re
import sys

macros = []
for name in sys.argv[1:]:
    text = open(name, encoding='utf-8').read()
    text = re.sub(r'/\*.*?\*/', ' ', text, flags=re.DOTALL)
    text = re.sub(r'^#(.*\\\n)*.*$', ' ', text, flags=re.MULTILINE)
    text = re.sub(r'\bTM_EXTERN_C_\w+', ' ', text)
    for statement in re.split('[;{}]', text):
        declaration = ' '.join(statement.split())
        found = re.match(r'(.*?)\b(tm_\w+)\((.*\btm_error \*.*)', declaration)
        if not found or re.search('_fail(_|$)', found[2]):
            continue # those fill it
        returned, function, parameters = found.groups()
        if not parameters.endswith('tm_error *error)'):
            sys.exit(f'{name}: does not take the error last: {declaration}')
        parameters = re.sub(r'\([^()]*\)', '', parameters) # of a function, of an array
        before = [f'a{i}' for i in range(parameters.count(','))]
        call = f'({function})({", ".join(before + ["NULL"])})'
        if returned == 'tm_status ':
            call = f'null_error({call}, error)'
        macros.append(f'#define {function}({", ".join(before + ["error"])}) {call}')

if not macros:
    sys.exit('no function takes a tm_error')
print('static inline tm_status null_error(tm_status status, tm_error *error)\n{\n'
      '    return status == TM_OK ? status : tm_fail(error, status, "was not said");\n}',
      *macros, sep='\n')
