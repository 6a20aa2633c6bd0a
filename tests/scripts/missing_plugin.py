# As scripts with plugins do: without the plugin they stop by themselves.
from openravepy import *
env = Environment()
RaveLoadPlugin('or_missing')
module = RaveCreateModule(env, 'missing')
if module is None:
    print('no plugin')
    try:
        env.AddModule(module, '')
    except openrave_exception as e:
        print(e.GetCode())
    try:
        env.LoadProblem(RaveCreateProblem(env, 'nosuch'), '')
    except openrave_exception as e:
        print(e.GetCode())
print(env.GetModules(), env.GetLoadedProblems())
module = RaveCreateProblem(env, 'basemanipulation')
env.LoadProblem(module, 'arm')
print(*[one.GetXMLId() for one in env.GetLoadedProblems()])
