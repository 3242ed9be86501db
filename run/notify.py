import socket,sys,time,os
p='/tmp/ck/run/notify.sock'
try: os.unlink(p)
except: pass
s=socket.socket(socket.AF_UNIX,socket.SOCK_DGRAM); s.bind(p)
t=time.time()
while True:
    d=s.recv(4096); print(round(time.time()-t,2), repr(d.decode())); sys.stdout.flush()
