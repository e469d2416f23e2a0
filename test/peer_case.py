"""The case of one tetrahedron that the tests of ./dev bench peers share."""

CASE = '''
peer_case 1
scene cell.yaml
dimension 3
order 1
layers 1
linear 17900 0.45
nodes 4 4
0 0 0
1e-06 0 0
0 1e-06 0
0 0 1e-06
elements 1
0 0 1 2 3
surface 1
0 2 1
held 1
0   # a comment
glued 1
3
tip disc sticking 3e-06 2.8e-05
motion 2
0 0 -1e-07
0 0 -2e-07
end
'''
